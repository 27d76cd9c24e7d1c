# Mirror images and rotations must agree bit for bit: a*b + c*d must not become fma(a, b, c*d), which prefers one product.
target_compile_options(bagnold_shallow PRIVATE -ffp-contract=off -fopenmp-simd)
