#pragma once

#include "fuzz/random.h"

#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

/// \file
/// What the program tries, by name. A target makes everything from its seed: the same seed is the same trial.

namespace hooke::fuzz {

/// Something is wrong with what was tried.
struct Failure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

inline void expect(bool holds, const std::string& what) {
  if (!holds) throw Failure(what);
}

/// Where files are, and how much to say.
struct Setting {
  std::string scenes = {};          ///< The folder of scenes.
  std::string corpus = {};          ///< The folder of files that failed once.
  std::string importer = {};        ///< hooke-import
  std::string save = {};            ///< Where to write the file that is tried; empty for nowhere.
  std::string figure = {};          ///< The only one that counts, of `rooms`; empty for all.
  double above = 0;                 ///< Figures below it do not count.
  bool verbose = false;             ///< Say each step of a trial.
  std::vector<bool> left_out = {};  ///< Parts of the trial, by number; for finding the few that matter.
};
[[nodiscard]] Setting& setting();

/// A line about the trial that runs, shown with --verbose. The last ones stand in the report of a failure.
void note(std::string line);
[[nodiscard]] std::vector<std::string>& notes();  ///< Of the trial that runs.

/// Writes what a loader is about to read to Setting::save.
void save_tried(std::span<const std::byte> bytes);

/// Trials of several parts, objects or calls, ask this before each. Each part has its own random numbers, so
/// that the others stay the same without it.
[[nodiscard]] bool has_next_part();
[[nodiscard]] std::size_t& part_count();  ///< Of the trial that runs, so far.

/// The worst of a figure in many trials, and whose it is.
struct WorstFigure {
  char name[32] = {};
  double value = 0;
  std::uint64_t seed = 0;
};
/// Says what a trial measured, sound or not. The largest of each name is listed when all are done.
void keep_figure(const char* name, double value);
[[nodiscard]] std::vector<WorstFigure>& figures();  ///< Of the trial that runs, without seeds.

struct Target {
  const char* name = nullptr;
  void (*run)(Random& random) = nullptr;
};

void try_api(Random& random);
void try_scene(Random& random);
void try_json(Random& random);
void try_flat(Random& random);
void try_bsp(Random& random);
void try_meshes(Random& random);
void try_import(Random& random);
void try_room(Random& random);
void try_hands(Random& random);

// What the loaders must do with any bytes; shared with libFuzzer.
void check_json(std::string text);
void check_flat(std::span<const std::byte> bytes);
void check_bsp(std::span<const std::byte> bytes);

}  // namespace hooke::fuzz
