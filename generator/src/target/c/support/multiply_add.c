/* a b + c: product and sum are rounded one after the other, as in Rust over f64. With BRYANT_FUSED both are rounded at once, as in lanes; that is slow
   where the processor has no such instruction or the compiler may not use it. */
#ifdef BRYANT_FUSED
#define MULTIPLY_ADD(a, b, c) fma(a, b, c)
#else
#define MULTIPLY_ADD(a, b, c) ((a) * (b) + (c))
#endif
