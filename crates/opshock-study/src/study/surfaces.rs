//! The named air-bearing surfaces, each as the text of a surface file.

/// Text of a named surface, in the form of a surface file.
pub fn text(name: &str) -> Option<&'static str> {
    (name == "femto-2.5in").then_some(FEMTO)
}

/// A three-pad femto surface with a shallow leading rail, side pads and a trailing centre pad:
/// opshock's own design. Lengths from the leading edge and the inner side.
const FEMTO: &str = r#"base_recess_um = 1.5
crown_nm = 15.0
camber_nm = 2.0
twist_nm = 0.0

[[rail]]
kind = "rect"
x_um = [20, 170]
y_um = [30, 670]
recess_um = 0.25

[[rail]]
kind = "rect"
x_um = [170, 240]
y_um = [50, 650]
recess_um = 0.0

[[rail]]
kind = "rect"
x_um = [240, 720]
y_um = [30, 100]
recess_um = 0.25

[[rail]]
kind = "rect"
x_um = [640, 720]
y_um = [30, 100]
recess_um = 0.0

[[rail]]
kind = "rect"
x_um = [240, 720]
y_um = [600, 670]
recess_um = 0.25

[[rail]]
kind = "rect"
x_um = [640, 720]
y_um = [600, 670]
recess_um = 0.0

[[rail]]
kind = "rect"
x_um = [600, 710]
y_um = [210, 490]
recess_um = 0.25

[[rail]]
kind = "rect"
x_um = [710, 840]
y_um = [250, 450]
recess_um = 0.0
"#;
