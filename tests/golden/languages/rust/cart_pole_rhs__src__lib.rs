// made by eomgen from models/cart_pole.toml
#![no_std]

mod math;
pub mod rhs;
