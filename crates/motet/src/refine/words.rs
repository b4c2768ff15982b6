//! What is divided and what is taken back, in words: what files, Python and other callers give.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::choose::{Criterion, Limits, Stated, Target};
use super::reach::Wanted;
use crate::base::{Error, Result};
use crate::words;

words! {
    /// What is divided, how far, and what is taken back. A tet is divided where any criterion marks it;
    /// criteria are texts, lengths are in the unit of the mesh, values in that of their array.
    pub struct RefineWords {
        /// Everything is divided.
        all: bool = false,
        /// Tets within a distance of a surface (a surface file, or a mesh: its boundary) are divided:
        /// `SURFACE=DISTANCE`.
        near: Vec<String> = Vec::new(),
        /// Tets are divided until no edge is longer than H at a surface, plus GROWTH per unit of distance
        /// from it, by default 0.5: `SURFACE=H,GROWTH`.
        near_size: Vec<String> = Vec::new(),
        /// Tets whose centre is in a box are divided: `X0,Y0,Z0,X1,Y1,Z1`, the lowest corner first.
        in_box as "box": Vec<String> = Vec::new(),
        /// Tets that overlap a ball are divided: `X,Y,Z,RADIUS`.
        ball: Vec<String> = Vec::new(),
        /// Tets of a region, by name or number, are divided.
        region: Vec<String> = Vec::new(),
        /// Tets that touch a patch, or lie within a distance of it, are divided: `PATCH` or
        /// `PATCH=DISTANCE`.
        patch: Vec<String> = Vec::new(),
        /// Tets are divided until no edge is longer than this, or than the value of an array on points or
        /// cells: `H` or `ARRAY`.
        size: Vec<String> = Vec::new(),
        /// Tets where an array satisfies a condition, on cells or at one of their points, are divided, such
        /// as `shear > 2`, with one of `> >= < <= == !=`.
        conditions as "where": Vec<String> = Vec::new(),
        /// Tets through which an array changes by more than this, its gradient times the longest edge, are
        /// divided: `ARRAY>VALUE`.
        gradient: Vec<String> = Vec::new(),
        /// The fewest tets are divided that hold this share of the error, such as 0.5, estimated by jumps of
        /// the gradient (Kelly); or so many that there are N tets: `ARRAY=SHARE` or `ARRAY=Ntets`.
        jump: Vec<String> = Vec::new(),
        /// The fewest tets are divided that hold this share of the error, estimated by a recovered gradient
        /// (Zienkiewicz and Zhu); or so many that there are N tets: `ARRAY=SHARE` or `ARRAY=Ntets`.
        recovery: Vec<String> = Vec::new(),
        /// Tets are divided until edges are short enough for the second derivatives of arrays, so that errors
        /// are at most ERROR, or P percent of the range of each array; or until there are N tets:
        /// `ARRAY,ARRAY=ERROR`, `=P%` or `=Ntets`.
        hessian: Vec<String> = Vec::new(),
        /// Tets where the vorticity of a velocity is above this are divided: `ARRAY>VALUE`.
        vorticity: Vec<String> = Vec::new(),
        /// Tets where Q of a velocity is above this, so that it rotates more than it shears, are divided:
        /// `ARRAY>VALUE`.
        q: Vec<String> = Vec::new(),
        /// The largest number of divisions of a tet in a call. By default 1, and for sizes as many as they
        /// take. Where `coarsen` stands alone, the number of divisions that are taken back.
        generations: Option<u32> = Wanted::default().generations,
        /// No tet is divided more often than this since the first mesh, earlier calls included.
        limit_generation: Option<u8> = Limits::default().generation,
        /// No tet is divided whose parts would have no edge as long as this.
        smallest: Option<f64> = Limits::default().smallest,
        /// Tets are divided only until there are about so many; those with the largest wishes, and the
        /// largest, first.
        at_most: Option<usize> = Limits::default().n_tets,
        /// Divisions are taken back where no criterion marks.
        coarsen: bool = Wanted::default().coarsen,
        /// Divisions are taken back where an array satisfies a condition on all eight parts, and no criterion
        /// marks: `ARRAY>VALUE`.
        coarsen_where: Vec<String> = Vec::new(),
    }
}

impl RefineWords {
    /// Checks a text of a word.
    ///
    /// # Errors
    /// When the word takes no texts, or the text does not have its syntax; the error says what is expected.
    pub fn check(word: &str, text: &str) -> Result<()> {
        match word {
            "coarsen_where" => Criterion::of_text("where", text).map(|_| ()),
            _ => Stated::of(word, text).map(|_| ()),
        }
    }

    /// The files of the surfaces that criteria measure from.
    ///
    /// # Errors
    /// When a text does not have the syntax of its word.
    pub fn surfaces(&self) -> Result<Vec<PathBuf>> {
        Ok(self.stated()?.iter().filter_map(|stated| stated.surface().map(Path::to_owned)).collect())
    }

    /// All criteria; `read` reads the surface of a file.
    ///
    /// # Errors
    /// When a text does not have the syntax of its word, and the errors of `read`.
    pub fn criteria(&self, read: impl Fn(&Path) -> Result<Arc<Target>>) -> Result<Vec<Criterion>> {
        let all = self.all.then_some(Criterion::All).into_iter().map(Ok);
        all.chain(self.stated()?.into_iter().map(|stated| stated.criterion(&read))).collect()
    }

    /// The goal with these criteria, which may come from [`criteria`](Self::criteria) or from elsewhere, and
    /// with the limits and conditions that the words determine.
    ///
    /// # Errors
    /// When nothing says what to divide or to take back, or a number is out of range.
    pub fn wanted(&self, mut criteria: Vec<Criterion>) -> Result<Wanted> {
        if criteria.is_empty() && !self.coarsen && self.coarsen_where.is_empty() {
            return Err(Error::options("no criterion is given: nothing says what to divide")
                .remedy("give one, such as near_size, ball or where, or coarsen"));
        }
        if let Some(smallest) = self.smallest {
            criteria.iter_mut().for_each(|criterion| limit_sizes(criterion, smallest));
        }
        criteria.iter().try_for_each(Criterion::check)?;
        let limits =
            Limits { generation: self.limit_generation, smallest: self.smallest, n_tets: self.at_most };
        limits.check()?;
        Ok(Wanted {
            criteria,
            coarsen: self.coarsen,
            coarsen_where: self.coarsen_where.iter().map(|text| text.parse()).collect::<Result<_>>()?,
            generations: self.generations,
            limits,
            ..Wanted::default()
        })
    }

    /// What all texts state, word by word.
    fn stated(&self) -> Result<Vec<Stated>> {
        let words: [(&str, &[String]); 14] = [
            ("near", &self.near),
            ("near_size", &self.near_size),
            ("box", &self.in_box),
            ("ball", &self.ball),
            ("region", &self.region),
            ("patch", &self.patch),
            ("size", &self.size),
            ("where", &self.conditions),
            ("gradient", &self.gradient),
            ("jump", &self.jump),
            ("recovery", &self.recovery),
            ("hessian", &self.hessian),
            ("vorticity", &self.vorticity),
            ("q", &self.q),
        ];
        let texts = words.into_iter().flat_map(|(word, texts)| texts.iter().map(move |text| (word, text)));
        texts.map(|(word, text)| Stated::of(word, text).map_err(|e| e.at(format!("`{word}`")))).collect()
    }
}

/// Gives sizes from second derivatives the smallest one.
fn limit_sizes(criterion: &mut Criterion, smallest: f64) {
    if let Criterion::Hessian(sizes) = criterion {
        sizes.limits.smallest = smallest;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::{Threads, Words};
    use crate::mesh::shapes;

    fn read(text: &str) -> RefineWords {
        serde_json::from_str(text).unwrap()
    }

    fn ball(_: &Path) -> Result<Arc<Target>> {
        Target::of_mesh(&shapes::ball(2, 1), &Threads::single()).map(Arc::new)
    }

    #[test]
    fn a_table_of_json_becomes_a_goal() {
        let words = read(
            r#"{"all": true, "near_size": ["a.stl=1"], "box": ["0,0,0,1,1,1"], "where": ["p>1"],
                "hessian": ["p=2%"], "smallest": 0.1, "at_most": 9, "coarsen_where": ["p<0"]}"#,
        );
        assert_eq!(words.surfaces().unwrap(), [Path::new("a.stl")]);
        let wanted = words.wanted(words.criteria(ball).unwrap()).unwrap();
        assert!(matches!(
            wanted.criteria[..],
            [
                Criterion::All,
                Criterion::NearSize { size: 1.0, growth: Criterion::GROWTH, .. },
                Criterion::Box(_),
                Criterion::Where(_),
                Criterion::Hessian(_),
            ]
        ));
        let Criterion::Hessian(sizes) = &wanted.criteria[4] else { panic!("the last is of sizes") };
        assert_eq!(sizes.limits.smallest, 0.1);
        assert_eq!(wanted.limits, Limits { smallest: Some(0.1), n_tets: Some(9), ..Limits::default() });
        assert_eq!(wanted.coarsen_where[0].to_string(), "p<0");
    }

    #[test]
    fn each_list_of_texts_is_a_word_of_criteria_or_of_conditions() {
        let words = RefineWords::words();
        let lists: Vec<&str> = words.iter().filter(|word| word.default == "[]").map(|w| w.name).collect();
        assert_eq!(lists.len(), 15);
        for word in lists {
            let text = format!(r#"{{"{word}": [""]}}"#);
            let words = read(&text);
            let error = match word {
                "coarsen_where" => words.wanted(vec![Criterion::All]).unwrap_err(),
                _ => words.criteria(ball).unwrap_err(),
            };
            let said = RefineWords::check(word, "").unwrap_err();
            assert_eq!(error.what(), said.what(), "{word}");
        }
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        let error = |text: &str| {
            let words = read(text);
            words.criteria(ball).and_then(|all| words.wanted(all)).unwrap_err().to_string()
        };
        assert!(error("{}").contains("no criterion"));
        assert!(error(r#"{"ball": ["1,2,3"]}"#).contains("`ball`: X,Y,Z,R has 4 numbers; got 3"));
        assert!(error(r#"{"all": true, "smallest": -1}"#).contains("the smallest edge length is -1"));
        let back = read(r#"{"coarsen": true, "generations": 2}"#).wanted(Vec::new()).unwrap();
        assert_eq!((back.coarsen, back.generations), (true, Some(2)));
    }
}
