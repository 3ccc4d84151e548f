struct Input;

mod elsewhere;

fn drag(input: Input) -> [f64; 2] {
    [0.0; 2]
}
