//! Rules for the rails of the slider's surface.

use opshock_solver::quantity;

use super::check::{Check, trim};
use crate::study::field::Field;
use crate::study::fields;
use crate::study::polygon;
use crate::study::words::RailKind;

impl Check<'_, '_> {
    pub(super) fn rails(&mut self) {
        let outline = [fields::SLIDER_LENGTH_MM, fields::SLIDER_WIDTH_MM];
        if !self.sound(&outline.each_ref().map(Field::path)) {
            return;
        }
        // Compared in SI: both sides are rounded once.
        let [length_m, width_m] = outline.each_ref().map(|field| self.view.get(field));
        let (length_um, width_um) = (length_m * 1e6, width_m * 1e6);
        let inside = |corner: [f64; 2]| {
            let slack = 1e-12;
            let [x, y] = corner.map(quantity::m_from_um);
            (-slack..=length_m + slack).contains(&x) && (-slack..=width_m + slack).contains(&y)
        };
        let allowed = format!(
            "0 to {} um along, 0 to {} um across",
            trim(length_um),
            trim(width_um)
        );
        for position in 0..self.view.get(&fields::SLIDER_SURFACE_RAIL) {
            let rail = format!("{}[{position}]", fields::SLIDER_SURFACE_RAIL.path());
            if !self.sound(&[&rail]) {
                continue;
            }
            let kind = self.view.entry(position, &fields::SLIDER_SURFACE_RAIL_KIND);
            if kind == RailKind::Polygon {
                let corners = &fields::SLIDER_SURFACE_RAIL_POINTS_UM;
                let points = self.view.entry(position, corners);
                self.polygon(&corners.of_entry(position), points, &inside, &allowed);
                continue;
            }
            let sides = [
                fields::SLIDER_SURFACE_RAIL_X_UM,
                fields::SLIDER_SURFACE_RAIL_Y_UM,
            ];
            for (axis, side) in sides.iter().enumerate() {
                let path = side.of_entry(position);
                for end in self.view.entry(position, side) {
                    let mut corner = [0.0; 2];
                    corner[axis] = end;
                    if !inside(corner) {
                        let fault = self.fault(
                            "E144",
                            &[&path],
                            format!("the rail reaches {end} um, outside the slider"),
                        );
                        fault.allowed = allowed.clone();
                    }
                }
            }
        }
    }

    pub(super) fn polygon(
        &mut self,
        path: &str,
        points: &[[f64; 2]],
        inside: &dyn Fn([f64; 2]) -> bool,
        allowed: &str,
    ) {
        let mut corners = points.to_vec();
        if corners.len() > 1 && corners.first() == corners.last() {
            corners.pop();
        }
        if corners.len() < 3 {
            let fault = self.fault(
                "E144",
                &[path],
                format!("the polygon is open: {} different corners", corners.len()),
            );
            fault.allowed = "3 corners or more".to_string();
            return;
        }
        if corners.len() > 2000 {
            let fault = self.fault(
                "E144",
                &[path],
                format!("the polygon has {} corners", corners.len()),
            );
            fault.allowed = "at most 2000 corners".to_string();
            return;
        }
        if let Some((position, corner)) = corners
            .iter()
            .enumerate()
            .find(|(_, corner)| !inside(**corner))
        {
            let fault = self.fault(
                "E144",
                &[path],
                format!(
                    "corner {} at [{}, {}] lies outside the slider",
                    position + 1,
                    corner[0],
                    corner[1]
                ),
            );
            fault.allowed = allowed.to_string();
        }
        if polygon::on_one_line(&corners) {
            let fault = self.fault("E144", &[path], "the polygon has no area");
            fault.allowed = "corners that are not on one line".to_string();
            return;
        }
        if let Some((first, second)) = polygon::crossing_edges(&corners) {
            let n = corners.len();
            let fault = self.fault(
                "E144",
                &[path],
                format!(
                    "the polygon crosses itself: edge {}-{} meets edge {}-{}",
                    first + 1,
                    (first + 1) % n + 1,
                    second + 1,
                    (second + 1) % n + 1
                ),
            );
            fault.allowed = "a simple polygon".to_string();
            return;
        }
        if polygon::signed_area(&corners) < 0.0 {
            let fault = self.fault(
                "N144",
                &[path],
                "the corners run clockwise; they are read in reverse order",
            );
            fault.allowed = "counter-clockwise corners".to_string();
        }
    }
}
