bagnold_hot(sph algorithm.cpp constitutive.cpp corrected_forces.cpp energy.cpp implicit.cpp kinematics.cpp order.cpp pair_forces.cpp
            pairs.cpp yield.cpp)
