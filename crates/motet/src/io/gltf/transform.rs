//! Where nodes of a scene are: affine maps.

use super::document::Node;
use crate::base::Point;

/// The images of the axes, and of the origin.
#[derive(Clone, Copy, Debug)]
pub(super) struct Transform {
    axes: [Point; 3],
    origin: Point,
}

impl Transform {
    pub(super) const IDENTITY: Self =
        Self { axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], origin: [0.0; 3] };

    /// The map from a node into the node above it: its matrix, or scale, rotation and translation, in this
    /// order.
    pub(super) fn of(node: &Node) -> Self {
        if let Some(m) = node.matrix {
            let column = |k: usize| [m[4 * k], m[4 * k + 1], m[4 * k + 2]];
            return Self { axes: [0, 1, 2].map(column), origin: column(3) };
        }
        let [x, y, z, w] = node.rotation.unwrap_or([0.0, 0.0, 0.0, 1.0]);
        let scale = node.scale.unwrap_or([1.0; 3]);
        // The columns of the rotation of a unit quaternion.
        let columns = [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)],
            [2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + w * x)],
            [2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)],
        ];
        let axes = [0, 1, 2].map(|k: usize| columns[k].map(|c| c * scale[k]));
        Self { axes, origin: node.translation.unwrap_or_default() }
    }

    /// The map of a node inside this one.
    pub(super) fn then(&self, inner: &Self) -> Self {
        Self { axes: inner.axes.map(|axis| self.of_vector(axis)), origin: self.of_point(inner.origin) }
    }

    pub(super) fn of_point(&self, p: Point) -> Point {
        let v = self.of_vector(p);
        [0, 1, 2].map(|k| v[k] + self.origin[k])
    }

    fn of_vector(&self, p: Point) -> Point {
        [0, 1, 2].map(|k| self.axes[0][k] * p[0] + self.axes[1][k] * p[1] + self.axes[2][k] * p[2])
    }

    /// Whether it turns left hands into right ones.
    pub(super) fn is_mirror(&self) -> bool {
        let [a, b, c] = self.axes;
        let cross = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
        cross[0] * c[0] + cross[1] * c[1] + cross[2] * c[2] < 0.0
    }
}
