//! One file a verb.

pub(crate) mod convert;
pub(crate) mod info;
