//! Pieces of the pages of reports, which load nothing from anywhere.

use crate::picture::write_png;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use std::io;

/// Returns text as it stands in HTML and XML, also within an attribute's double quotes.
pub(crate) fn escape(text: &str) -> String {
    let text = text.replace('&', "&amp;").replace('<', "&lt;");
    text.replace('>', "&gt;").replace('"', "&quot;")
}

/// Returns sRGB pixels as PNG in a URL.
///
/// # Errors
/// If the picture cannot be encoded.
pub(crate) fn picture_url(size: [u16; 2], pixels: &[u8]) -> io::Result<String> {
    let mut png = Vec::new();
    write_png(&mut png, size.map(u32::from), pixels, None)?;
    Ok(format!("data:image/png;base64,{}", STANDARD.encode(png)))
}
