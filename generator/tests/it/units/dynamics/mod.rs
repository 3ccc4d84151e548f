mod augmented;
mod elimination;
