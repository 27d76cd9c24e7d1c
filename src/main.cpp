#include "app/cli.hpp"
#include "core/memory.hpp"

int main(int argc, char** argv) {
  bagnold::return_large_arrays();
  return bagnold::app::run(argc, argv);
}
