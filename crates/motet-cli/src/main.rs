//! The command line of motet.

fn main() {}
