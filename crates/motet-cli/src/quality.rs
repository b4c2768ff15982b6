//! Tables of the quality of all tets of a mesh, as every verb prints them.

use motet::mesh::Qualities;

use crate::table::{Table, short};

/// The column headings of [`row`].
pub(crate) const HEADER: [&str; 6] = ["worst EAS", "1 % below", "5 % below", "median", "mean", "mean ratio"];

/// The distribution of the EAS of all tets and the mean of their mean ratios; dashes where there are no tets.
pub(crate) fn row(quality: Option<&Qualities>) -> [String; 6] {
    let Some(Qualities { worst, p1, p5, median, mean, mean_ratio }) = quality else {
        return HEADER.map(|_| "-".into());
    };
    [worst, p1, p5, median, mean, mean_ratio].map(|x| short(*x))
}

/// A table with a row for each mesh, or each time of a mesh.
pub(crate) fn table<S: Into<String>>(rows: impl IntoIterator<Item = (S, Option<Qualities>)>) -> Table {
    let mut table = Table::new(["quality of all tets"].into_iter().chain(HEADER));
    for (name, quality) in rows {
        table.row([name.into()].into_iter().chain(row(quality.as_ref())));
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_has_a_number_for_each_name() {
        let quality = Qualities { worst: 0.1, p1: 0.2, p5: 0.3, median: 0.6, mean: 0.5, mean_ratio: 0.8 };
        let printed = table([("before", Some(quality)), ("after", None)]).to_string();
        let rows: Vec<&str> = printed.lines().collect();
        assert_eq!(rows.len(), 3);
        assert!(rows[0].ends_with("mean   mean ratio"));
        let numbers: Vec<&str> = rows[1].split_whitespace().skip(1).collect();
        assert_eq!(numbers, ["0.1000", "0.2000", "0.3000", "0.6000", "0.5000", "0.8000"]);
        assert_eq!(rows[2].matches(" -").count(), 6);
    }
}
