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
/// White: the ground of figures, and the inside of open marks.
pub const WHITE: Rgb = (0xff, 0xff, 0xff);
/// Words.
pub const TEXT: Rgb = (0x22, 0x22, 0x22);
/// Words of less weight.
pub const QUIET_TEXT: Rgb = (0x66, 0x66, 0x66);
/// Grid lines.
pub const GRID: Rgb = (0xe4, 0xe4, 0xe4);
/// Grid lines between those with labels.
pub const FAINT_GRID: Rgb = (0xf2, 0xf2, 0xf2);
/// The line of zero.
pub const ZERO: Rgb = (0xb0, 0xb0, 0xb0);
/// A shaded stretch.
pub const SHADE: Rgb = (0xf4, 0xf1, 0xea);

/// The ground of pages and figures where dark ones are preferred.
pub const DARK_GROUND: Rgb = (0x16, 0x19, 0x1d);
/// Colours with those that stand for them on [`DARK_GROUND`]: same hues, contrast above 4.5 for words and 3 for marks.
pub const DARK: [(Rgb, Rgb); 15] = [
    (WHITE, DARK_GROUND),
    (TEXT, (0xe6, 0xe6, 0xe6)),
    (QUIET_TEXT, (0xa8, 0xad, 0xb3)),
    (GRID, (0x33, 0x38, 0x3e)),
    (FAINT_GRID, (0x24, 0x28, 0x2d)),
    (ZERO, (0x5c, 0x62, 0x69)),
    (SHADE, (0x2a, 0x28, 0x22)),
    (BLACK, (0xee, 0xee, 0xee)),
    (VERMILLION, (0xff, 0x8a, 0x4c)),
    (BLUE, (0x4c, 0x9b, 0xe8)),
    (GREEN, (0x2f, 0xc7, 0x9a)),
    (PURPLE, (0xe3, 0x9a, 0xc6)),
    (SKY, (0x9a, 0xd8, 0xff)),
    (ORANGE, (0xff, 0xc1, 0x4d)),
    (GREY, (0x9a, 0x9f, 0xa5)),
];

/// As SVG and CSS write it.
pub fn hex((r, g, b): Rgb) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// A style sheet that replaces the colours of a figure's attributes where a dark page is preferred; paper stays light.
pub fn dark_style() -> String {
    let mut rules = String::new();
    for (light, dark) in DARK {
        for property in ["fill", "stroke"] {
            let (light, dark) = (hex(light), hex(dark));
            rules.push_str(&format!("[{property}=\"{light}\"]{{{property}:{dark}}}"));
        }
    }
    format!(
        "@media screen and (prefers-color-scheme: dark){{{rules}[fill=\"white\"]{{fill:{}}}}}",
        hex(DARK_GROUND)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Contrast of two colours (WCAG 2.2).
    fn contrast(a: Rgb, b: Rgb) -> f64 {
        let luminance = |(r, g, b): Rgb| {
            let linear = |v: u8| {
                let v = f64::from(v) / 255.0;
                match v <= 0.04045 {
                    true => v / 12.92,
                    false => ((v + 0.055) / 1.055).powf(2.4),
                }
            };
            0.2126 * linear(r) + 0.7152 * linear(g) + 0.0722 * linear(b)
        };
        let (a, b) = (luminance(a), luminance(b));
        (a.max(b) + 0.05) / (a.min(b) + 0.05)
    }

    #[test]
    fn marks_and_words_stand_out_from_the_dark_ground() {
        assert!((contrast((0, 0, 0), WHITE) - 21.0).abs() < 1e-9);
        let dark = |light: Rgb| DARK.iter().find(|(known, _)| *known == light).unwrap().1;
        for text in [TEXT, QUIET_TEXT] {
            assert!(contrast(dark(text), DARK_GROUND) > 4.5, "{text:?}");
        }
        for mark in CYCLE.into_iter().chain([GREY]) {
            assert!(contrast(dark(mark), DARK_GROUND) > 3.0, "{mark:?}");
        }
    }

    #[test]
    fn every_colour_of_series_has_a_dark_one_and_the_style_names_both() {
        let style = dark_style();
        for colour in CYCLE {
            assert!(
                style.contains(&format!("[stroke=\"{}\"]", hex(colour))),
                "{colour:?}"
            );
        }
        assert!(style.starts_with("@media screen and (prefers-color-scheme: dark)"));
    }
}
