//! Text of unknown encoding.

/// Decodes UTF-8 if valid, otherwise Latin-1.
pub(super) fn decode_utf8_or_latin1(bytes: &[u8]) -> String {
    match std::str::from_utf8(bytes) {
        Ok(text) => text.to_owned(),
        Err(_) => bytes.iter().map(|&b| char::from(b)).collect(),
    }
}
