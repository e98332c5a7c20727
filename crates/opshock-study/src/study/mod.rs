//! Reads study files, checks them and makes their points: every combination of the values on their axes.
//!
//! A study is TOML with a unit in every key. One table of keys ([`keys::KEYS`]) says what may
//! stand in it; reading, messages, defaults, the JSON Schema and the resolved study all come from
//! that table. Reading reports every fault at once, each with its place, and never guesses:
//!
//! ```text
//! text -> tree (places) -> settings (kind, range, unit) -> completed (defaults, surface)
//!      -> checked (geometry, pulse, search) -> points, each with a scene in SI
//! ```
//!
//! ```
//! use opshock_study::study::Study;
//!
//! let study = Study::from_text(&Study::example("my drive"), &[]).unwrap();
//! assert_eq!(study.points.len(), 18);
//! ```

mod checked;
mod complete;
mod datum;
pub mod difference;
mod example;
pub mod fault;
pub mod field;
pub mod fields;
pub mod film_memory;
mod imported_base;
pub mod imported_suspension;
mod included;
pub mod key;
pub mod keys;
pub mod matrices;
pub mod measured_pulse;
pub mod memory;
mod overlay;
mod points;
mod polygon;
mod ramp_geometry;
mod ramp_mesh;
mod ramp_remeshed;
mod ramp_solid;
mod read;
mod recorded;
pub mod reference;
mod renamed;
mod resolved;
pub mod samples;
mod scene;
pub mod schema;
mod select;
mod set_arg;
mod settings;
pub mod source;
pub(crate) mod suggest;
mod surfaces;
pub(crate) mod table_fields;
pub mod text_file;
pub(crate) mod tree;
pub mod unit;
mod validity;
mod words;

pub use crate::search::{Ramp, Sign};
pub use checked::{AddedPointsSettings, OutputSettings, SearchSettings, Study, check_threads};
pub use fault::{Severity, StudyError, StudyErrors};
pub use overlay::Override;
pub use points::{Axis, AxisValue, HEADS, Point};
pub use ramp_geometry::RampSolid;
pub use ramp_remeshed::RemeshedRamp;
pub use recorded::MeasuredPulse;
pub use resolved::{digest_of, number_at};
pub use select::{Choice, ChoiceError, FreeAxis, Shot};
pub use set_arg::{SetArg, SetSyntaxError, is_within};
pub use words::{
    Effects, Faces, KeepHistories, LeftOut, UncertaintyOf, coupling_word, preset_word,
};
