//! Pages: what they contain, what they draw, what is refused.

mod drawn;
mod page;
