#include "hooke/model_io.h"

#include "base/float_environment.h"
#include "io/folder_file.h"
#include "process/new_file.h"

#include <array>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace hooke {

namespace {

constexpr std::string_view kMaterials =
    "newmtl outside\nKd 0.8 0.8 0.8\nKs 0.2 0.2 0.2\nNs 16\nd 1\n\n"
    "newmtl inside\nKd 0.6 0.55 0.5\nKs 0 0 0\nNs 16\nd 1\n";

/// Appends the shortest text that reads back as the same float, whatever the locale.
void append_number(std::string& text, double value) {
  std::array<char, 32> buffer = {};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), static_cast<float>(value)).ptr;
  text += ' ';
  text.append(buffer.data(), end);
}

/// Appends those faces of a cell that are, or are not, part of the whole's surface. Vertices of the file that
/// come before those of the cell are `first` many.
void append_faces(std::string& text, const FractureCell& cell, bool outside, std::size_t first) {
  bool has_any = false;
  for (std::size_t t = 0; t < cell.mesh.triangles.size(); ++t) {
    if ((cell.across[t] == FractureCell::kSurface) != outside) continue;
    if (!has_any) text += outside ? "usemtl outside\n" : "usemtl inside\n";
    has_any = true;
    text += 'f';
    for (const std::uint32_t v : cell.mesh.triangles[t]) text += ' ' + std::to_string(first + v + 1);
    text += '\n';
  }
}

std::string write_cells(const Fracture& fracture, const std::string& library) {
  std::string text = "# meters, y up\nmtllib " + library + "\ns off\n";
  std::size_t first = 0;
  for (std::size_t i = 0; i < fracture.cells.size(); ++i) {
    const FractureCell& cell = fracture.cells[i];
    text += "o cell_" + std::to_string(i) + '\n';
    for (const Vec3& p : cell.mesh.positions) {
      const DVec3 place = cell.center + vector_cast<double>(p);
      text += 'v';
      for (const double number : {place.x, place.y, place.z}) append_number(text, number);
      text += '\n';
    }
    append_faces(text, cell, true, first);
    append_faces(text, cell, false, first);
    first += cell.mesh.positions.size();
  }
  return text;
}

}  // namespace

Result<void> export_cells(const Fracture& fracture, const std::string& path) {
  const base::FloatEnvironment environment;
  std::filesystem::path library(path);
  const std::string ending = io::lower_ending(library);
  if (ending != ".obj" || path.find('\0') != std::string::npos)
    return Error{ErrorCode::kOutOfRange, path, "cells are written as .obj, which has named objects"};
  library.replace_extension(".mtl");
  const std::string text = write_cells(fracture, library.filename().string());
  // The materials are written first, so that an .obj file always finds its .mtl file.
  if (auto written = process::write_file(library.string(), kMaterials); !written) return written;
  return process::write_file(path, text);
}

}  // namespace hooke
