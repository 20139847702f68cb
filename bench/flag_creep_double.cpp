#include "flag_creep.h"

int main() {
  return hooke::bench::print_solver_rows("solver, double");
}
