"""What each command of the command line gives, one verb a file. No physics, no printing."""
