use bryant_generator::target::rust::results::upper_triangle;

#[test]
fn the_upper_triangle_is_counted_by_rows() {
    let mut next = 0;
    for row in 0..5 {
        for column in row..5 {
            assert_eq!(upper_triangle(5, row, column), next);
            assert_eq!(upper_triangle(5, column, row), next);
            next += 1;
        }
    }
}
