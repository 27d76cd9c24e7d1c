// What the program knows of the machine it runs on: written into records, never into results.
#pragma once

namespace bagnold::app {

double cpu_seconds();  // that all threads of this process have taken so far

}  // namespace bagnold::app
