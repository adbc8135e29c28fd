//! Curves of any number of points, drawn with few.

/// A point of a curve: place and value.
pub(super) type Point = (f64, f64);

/// The curve in pieces, thinned to what can be seen: of the points that share a column, the first, the least, the
/// largest and the last stay. `None` is a gap, where a piece ends; a gap within a column ends it there.
///
/// `column` says in which column a place lies; places go up.
pub(super) fn pieces(points: &[Option<Point>], column: impl Fn(f64) -> i64) -> Vec<Vec<Point>> {
    let mut pieces = Vec::new();
    let mut piece = Vec::new();
    let mut gap = false;
    let mut here: Option<(i64, Column)> = None;
    for point in points {
        let Some(point) = *point else {
            gap = true;
            continue;
        };
        let at = column(point.0);
        match &mut here {
            Some((current, column)) if *current == at => column.add(point),
            _ => {
                if let Some((_, column)) = here.replace((at, Column::of(point))) {
                    column.append_to(&mut piece);
                }
                if gap && !piece.is_empty() {
                    pieces.push(std::mem::take(&mut piece));
                }
                gap = false;
            }
        }
    }
    if let Some((_, column)) = here {
        column.append_to(&mut piece);
        pieces.push(piece);
    }
    pieces
}

/// What stays of the points of one column.
struct Column {
    first: Point,
    least: Point,
    largest: Point,
    last: Point,
}

impl Column {
    fn of(point: Point) -> Column {
        Column { first: point, least: point, largest: point, last: point }
    }

    fn add(&mut self, point: Point) {
        if point.1 < self.least.1 {
            self.least = point;
        }
        if point.1 > self.largest.1 {
            self.largest = point;
        }
        self.last = point;
    }

    fn append_to(&self, piece: &mut Vec<Point>) {
        let mut kept = vec![self.first, self.least, self.largest, self.last];
        kept.sort_by(|a, b| a.0.total_cmp(&b.0));
        kept.dedup();
        piece.extend(kept);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extremes_survive_and_little_else() {
        let value = |i: usize| match i {
            70_001 => 1.0,
            70_002 => 0.0,
            _ => 0.5 + (i % 7) as f64 / 100.0,
        };
        let points: Vec<_> = (0..100_000).map(|i| Some((i as f64, value(i)))).collect();
        let pieces = pieces(&points, |x| (x / 100.0) as i64);
        assert_eq!(pieces.len(), 1);
        assert!(pieces[0].len() <= 4 * 1000);
        assert!(pieces[0].contains(&(70_001.0, 1.0)) && pieces[0].contains(&(70_002.0, 0.0)));
        assert_eq!((pieces[0][0].0, pieces[0][pieces[0].len() - 1].0), (0.0, 99_999.0));
        assert!(pieces[0].is_sorted_by(|a, b| a.0 < b.0));
    }

    #[test]
    fn gaps_part_a_curve() {
        let points = [None, Some((1.0, 0.1)), None, None, Some((4.0, 0.2)), Some((5.0, 0.3)), None];
        let fine = pieces(&points, |x| x as i64);
        assert_eq!(fine, [vec![(1.0, 0.1)], vec![(4.0, 0.2), (5.0, 0.3)]]);
        assert!(pieces(&[None, None], |x| x as i64).is_empty());
        assert!(pieces(&[], |x| x as i64).is_empty());
    }

    #[test]
    fn any_number_of_gaps_makes_no_more_pieces_than_columns() {
        let points: Vec<_> = (0..10_000).map(|i| (i % 2 == 0).then_some((f64::from(i), 0.5))).collect();
        assert_eq!(pieces(&points, |x| (x / 1000.0) as i64).len(), 10);
    }
}
