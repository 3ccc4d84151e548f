mod augmented_body;
mod elimination;
