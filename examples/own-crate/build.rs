fn main() {
    bryant_generator::Config::new()
        .model("double-pendulum.yaml")
        .generate_or_report();
}
