//! On which side of a surface its gaps are.

/// The side of a body on which its gaps are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Side {
    /// Both sides of its triangles: a sheet, such as a leaflet or a flap.
    #[default]
    Both,
    /// The side that its triangles face: a stent or a coil whose triangles are turned outward.
    Outside,
    /// The side behind its triangles: the lumen, for a vessel whose triangles are turned outward.
    Inside,
}

impl Side {
    /// The opposite side; [`Both`](Self::Both) remains.
    pub(super) fn opposite(self) -> Self {
        match self {
            Self::Both => Self::Both,
            Self::Outside => Self::Inside,
            Self::Inside => Self::Outside,
        }
    }
}
