#include "hooke/model_io.h"

#include <cstdio>

int main(int /*count*/, char** words) {
  const hooke::Model model = hooke::import_model(words[1]).value();
  std::printf("%zu triangles\n", model.mesh.triangles.size());
}
