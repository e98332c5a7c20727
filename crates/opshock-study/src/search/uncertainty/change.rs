//! Change of the critical shock from one scene to another.

/// Change of the critical shock from one scene to another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Change {
    /// As a share; positive: the other's is larger.
    pub share: f64,
    /// By how much more it may differ, since either answer may lie anywhere in its bracket.
    pub resolution: f64,
    /// Both have the same bracket.
    pub is_equal: bool,
}

impl Change {
    /// The change from `before` to this one, both from the same scene.
    pub(super) fn since(self, before: Change) -> Change {
        Change {
            share: self.share - before.share,
            resolution: self.resolution.max(before.resolution),
            // Brackets have a resolution, clearances none.
            is_equal: self == before && self.resolution > 0.0,
        }
    }

    /// The same, seen from the other answer.
    pub(super) fn reversed(self) -> Change {
        Change {
            share: -self.share,
            ..self
        }
    }

    /// The largest distance of both answers.
    pub(super) fn size(self) -> f64 {
        self.share.abs() + self.resolution
    }
}
