bagnold_hot(cg deposit.cpp deposit_rows.cpp moments.cpp)
