#include "app/cli.hpp"

int main(int argc, char** argv) { return bagnold::app::run(argc, argv); }
