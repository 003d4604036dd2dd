"""The commands of the command line, one a file: each gives a document. No physics, no printing."""
