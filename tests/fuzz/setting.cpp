#include "fuzz/target.h"

#include <cstdio>
#include <fstream>

namespace hooke::fuzz {

Setting& setting() {
  static Setting one = {
      .scenes = HOOKE_SCENES, .corpus = HOOKE_FUZZ_CORPUS, .importer = HOOKE_BUILT_IMPORTER};
  return one;
}

std::vector<std::string>& notes() {
  static std::vector<std::string> lines;
  return lines;
}

void note(std::string line) {
  if (setting().verbose) {
    std::printf("%s\n", line.c_str());
    std::fflush(stdout);
  }
  notes().push_back(std::move(line));
}

void save_tried(std::span<const std::byte> bytes) {
  if (setting().save.empty()) return;
  std::ofstream(setting().save, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

std::vector<WorstFigure>& figures() {
  static std::vector<WorstFigure> all;
  return all;
}

void keep_figure(const char* name, double value) {
  WorstFigure figure = {.value = value};
  std::snprintf(figure.name, sizeof(figure.name), "%s", name);
  figures().push_back(figure);
}

std::size_t& part_count() {
  static std::size_t count = 0;
  return count;
}

bool has_next_part() {
  const std::size_t number = part_count()++;
  const std::vector<bool>& left_out = setting().left_out;
  return number >= left_out.size() || !left_out[number];
}

}  // namespace hooke::fuzz
