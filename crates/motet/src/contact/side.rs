//! On which side of a surface there is room.

/// Where the gaps of a body are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Side {
    /// On both sides of its triangles: a sheet, such as a leaflet or a flap.
    #[default]
    Both,
    /// Where its triangles face: a stent or a coil whose triangles are turned outward.
    Outside,
    /// Behind its triangles: the lumen, for a vessel whose triangles are turned outward.
    Inside,
}

impl Side {
    /// The other side.
    pub(super) fn turned(self) -> Self {
        match self {
            Self::Both => Self::Both,
            Self::Outside => Self::Inside,
            Self::Inside => Self::Outside,
        }
    }
}
