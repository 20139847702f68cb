/// hooke-import FILE UP SCALE FIT ORIGIN reads one model file and writes it in the flat format to standard
/// output.
///
/// UP is format, x, y or z; SCALE is a number of meters per unit; FIT is a length in meters or "none";
/// ORIGIN is file, center or bottom. The
/// exit code is an io::ImporterExit, and the reason is one line on standard error. The hooke library starts
/// the program for each file. It limits memory and time, reads the file and those that belong to it, seals
/// itself off from the system, and only then parses what it has read.

#include "companions.h"
#include "convert.h"
#include "files.h"
#include "io/model/model_flat.h"
#include "io/model/model_geometry.h"
#include "limits.h"
#include "refusal.h"
#include "sandbox.h"
#include "scan.h"

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <assimp/importerdesc.h>
#include <assimp/scene.h>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <memory>
#include <new>
#include <string>
#include <string_view>
#include <unistd.h>
#include <utility>
#include <vector>

namespace hooke::importer {

namespace {

using io::ImporterExit;

constexpr double kCrease = 0.7;  // Crease angle of 40 degrees [rad], as in model_of.

/// This is a file format that may come in, and the one importer that may read it.
struct Format {
  std::string_view ending;
  std::string_view importer;
  Frame frame;
  void (*scan)(std::span<const std::byte> bytes) = nullptr;
};

constexpr std::array<Format, 6> kFormats = {{
    {"3ds",
     "Discreet 3DS Importer",
     {.stands_upright = true, .stores_srgb = true, .up = UpAxis::kZ},
     scan_3ds},
    {"obj", "Wavefront Object Importer", {.stores_srgb = true}, scan_obj},
    {"stl",
     "Stereolithography (STL) Importer",
     {.has_materials = false, .has_normals = false, .up = UpAxis::kZ},
     nullptr},
    {"ply", "Stanford Polygon Library (PLY) Importer", {.has_materials = false}, scan_ply},
    {"gltf", "glTF2 Importer", {.names_are_uris = true}, scan_gltf},
    {"glb", "glTF2 Importer", {.names_are_uris = true}, scan_glb},
}};

struct Arguments {
  std::string path;
  UpAxis up = UpAxis::kFormat;
  double scale = 1.0;
  double fit = 0.0;
  ModelOrigin origin = ModelOrigin::kFile;
};

double positive_number(std::string_view text, const char* name) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !(value > 0.0 && value < 1e30)) {
    throw Refusal(ImporterExit::kOutOfRange, std::string(name) + " must be a positive number");
  }
  return value;
}

Arguments parse(int count, char** words) {
  if (count != 6) throw Refusal(ImporterExit::kOutOfRange, "usage: hooke-import FILE UP SCALE FIT ORIGIN");
  Arguments arguments = {.path = words[1]};
  constexpr std::array<std::string_view, 4> kUpWords = {"format", "x", "y", "z"};
  const auto* up = std::find(kUpWords.begin(), kUpWords.end(), std::string_view(words[2]));
  if (up == kUpWords.end()) throw Refusal(ImporterExit::kOutOfRange, "UP must be format, x, y or z");
  arguments.up = static_cast<UpAxis>(up - kUpWords.begin());
  arguments.scale = positive_number(words[3], "SCALE");
  if (std::string_view(words[4]) != "none") arguments.fit = positive_number(words[4], "FIT");
  constexpr std::array<std::string_view, 3> kOriginWords = {"file", "center", "bottom"};
  const auto* origin = std::find(kOriginWords.begin(), kOriginWords.end(), std::string_view(words[5]));
  if (origin == kOriginWords.end())
    throw Refusal(ImporterExit::kOutOfRange, "ORIGIN must be file, center or bottom");
  arguments.origin = static_cast<ModelOrigin>(origin - kOriginWords.begin());
  return arguments;
}

const Format& format_of(const std::string& path) {
  const auto dot = path.find_last_of("./");
  std::string ending = dot == std::string::npos || path[dot] == '/' ? "" : path.substr(dot + 1);
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const auto* format = std::find_if(kFormats.begin(), kFormats.end(),
                                    [&](const Format& candidate) { return candidate.ending == ending; });
  if (format == kFormats.end()) {
    throw Refusal(ImporterExit::kBadSyntax, "not one of .3ds .obj .stl .ply .gltf .glb");
  }
  return *format;
}

/// Leaves only `name` registered, because assimp tries other formats on a file it does not recognize.
void keep_only(Assimp::Importer& importer, std::string_view name) {
  for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
    const aiImporterDesc* description = importer.GetImporterInfo(i);
    if (description == nullptr || name != description->mName) {
      importer.UnregisterLoader(importer.GetImporter(i));
    }
  }
  if (importer.GetImporterCount() != 1) {
    throw Refusal(ImporterExit::kUnsupported, "this build of assimp cannot read the format");
  }
}

Model read_model(const Arguments& arguments) {
  const Format& format = format_of(arguments.path);
  const std::vector<std::byte> bytes = read_model_file(arguments.path, kMaxFileSize);
  if (bytes.empty()) throw Refusal(ImporterExit::kBadSyntax, "the file is empty");
  auto folder = std::make_unique<ModelFolder>(arguments.path, bytes,
                                              companion_names(arguments.path, format.ending, bytes));
  Assimp::Importer importer;
  keep_only(importer, format.importer);
  importer.SetIOHandler(folder.release());  // The importer owns it from here on.
  // Where there is no seal, only the limits protect the system.
  if (!kIsSanitized) static_cast<void>(seal_process());
  if (format.scan != nullptr) format.scan(bytes);
  const aiScene* scene = importer.ReadFile(arguments.path, 0);
  if (scene == nullptr) {
    throw Refusal(ImporterExit::kBadSyntax,
                  "not readable as ." + std::string(format.ending) + ": " + importer.GetErrorString());
  }
  Frame frame = format.frame;
  if (arguments.up != UpAxis::kFormat) frame.up = arguments.up;
  frame.scale = arguments.scale;
  frame.fit = arguments.fit;
  frame.origin = arguments.origin;
  const io::Soup soup = convert_scene(*scene, frame);
  return io::assemble_model(soup, kCrease);
}

void write_all(const std::vector<std::byte>& bytes) {
  for (std::size_t at = 0; at < bytes.size();) {
    const ssize_t done = ::write(STDOUT_FILENO, bytes.data() + at, bytes.size() - at);
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) throw Refusal(ImporterExit::kNotReadable, "cannot write to standard output");
    at += static_cast<std::size_t>(done);
  }
}

ImporterExit run(int count, char** words) {
  std::string reason;
  ImporterExit exit = ImporterExit::kBadSyntax;
  try {
    if (!enter_limits())
      throw Refusal(ImporterExit::kUnsupported, "the system refuses to limit the importer");
    const Model model = read_model(parse(count, words));
    if (const auto sound = io::check_model(model); !sound) {
      throw Refusal(ImporterExit::kOutOfRange, sound.error().message);
    }
    write_all(io::write_flat_model(model));
    return ImporterExit::kDone;
  } catch (const Refusal& refusal) {
    exit = refusal.exit();
    reason = refusal.what();
  } catch (const std::bad_alloc&) {
    exit = ImporterExit::kLimitExceeded;
    reason = "reading it took more than 1 GiB of memory";
  } catch (const std::exception& error) {
    reason = error.what();
  }
  std::fprintf(stderr, "%s\n", io::cleaned_text(reason).c_str());
  return exit;
}

}  // namespace

}  // namespace hooke::importer

int main(int count, char** words) {
  const auto exit = hooke::importer::run(count, words);
  // What assimp left for the end of the process was shaped by the file, so it is not run.
  ::_exit(static_cast<int>(exit));
}
