//! Colours that colour-blind readers and grey print distinguish (Okabe & Ito 2008).

/// sRGB.
pub type Rgb = (u8, u8, u8);
/// Black.
pub const BLACK: Rgb = (0x1a, 0x1a, 0x1a);
/// Orange-red.
pub const VERMILLION: Rgb = (0xd5, 0x5e, 0x00);
/// Blue.
pub const BLUE: Rgb = (0x00, 0x72, 0xb2);
/// Bluish green.
pub const GREEN: Rgb = (0x00, 0x9e, 0x73);
/// Reddish purple.
pub const PURPLE: Rgb = (0xcc, 0x79, 0xa7);
/// Sky blue.
pub const SKY: Rgb = (0x56, 0xb4, 0xe9);
/// Orange.
pub const ORANGE: Rgb = (0xe6, 0x9f, 0x00);
/// Grey, for what is in the background.
pub const GREY: Rgb = (0x8c, 0x8c, 0x8c);
/// Order in which series take their colours.
pub const CYCLE: [Rgb; 7] = [BLACK, BLUE, VERMILLION, GREEN, PURPLE, SKY, ORANGE];
