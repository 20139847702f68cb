#include "render/video.h"

#include "render/stage.h"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <doctest/doctest.h>
#include <sys/resource.h>

using hooke::ErrorCode;
using hooke::render::Image;
using hooke::render::VideoOptions;
using hooke::render::VideoWriter;
using hooke::render_test::TemporaryFolder;

namespace {

bool has_ffmpeg() {
  const bool found = std::system("command -v ffmpeg >/dev/null && command -v ffprobe >/dev/null") == 0;
  if (!found) MESSAGE("skipped: there is no ffmpeg");
  return found;
}

/// A frame of one color, or of noise that does not compress.
Image make_frame(int width, int height, int shade, bool noisy = false) {
  Image image{width, height, 3, {}};
  std::uint32_t state = static_cast<std::uint32_t>(shade) + 1;
  for (int i = 0; i < width * height * 3; ++i) {
    state = state * 1664525U + 1013904223U;
    image.pixels.push_back(
        static_cast<std::uint8_t>(noisy ? state >> 24 : static_cast<std::uint32_t>(shade)));
  }
  return image;
}

hooke::Result<void> write_frames(const VideoOptions& options, int count) {
  auto writer = VideoWriter::create(options);
  if (!writer) return writer.error();
  for (int i = 0; i < count; ++i) {
    const auto added = writer.value().add(make_frame(options.width, options.height, 20 * i));
    if (!added) return added;
  }
  return writer.value().finish();
}

/// "width,height,frames" as ffprobe counts them.
std::string probe(const std::string& path) {
  const std::string command =
      "ffprobe -v error -count_frames -select_streams v:0 -show_entries "
      "stream=width,height,nb_read_frames -of csv=p=0 '" +
      path + "'";
  std::string answer;
  std::FILE* pipe = ::popen(command.c_str(), "r");
  REQUIRE(pipe != nullptr);
  std::array<char, 64> line{};
  while (std::fgets(line.data(), line.size(), pipe) != nullptr) answer += line.data();
  ::pclose(pipe);
  while (!answer.empty() && answer.back() == '\n') answer.pop_back();
  return answer;
}

/// Changes a variable of the environment until the end of the scope.
class ScopedVariable {
 public:
  ScopedVariable(const char* name, const char* value) : name_(name) {
    const char* old = std::getenv(name);
    old_ = old != nullptr ? old : "";
    ::setenv(name, value, 1);
  }
  ScopedVariable(const ScopedVariable&) = delete;
  ScopedVariable& operator=(const ScopedVariable&) = delete;
  ~ScopedVariable() { ::setenv(name_, old_.c_str(), 1); }

 private:
  const char* name_;
  std::string old_;
};

/// Lets no process started in the scope write a longer file.
class ScopedFileLimit {
 public:
  explicit ScopedFileLimit(rlim_t bytes) {
    ::getrlimit(RLIMIT_FSIZE, &old_);
    const rlimit smaller = {bytes, old_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &smaller);
  }
  ScopedFileLimit(const ScopedFileLimit&) = delete;
  ScopedFileLimit& operator=(const ScopedFileLimit&) = delete;
  ~ScopedFileLimit() { ::setrlimit(RLIMIT_FSIZE, &old_); }

 private:
  rlimit old_ = {};
};

}  // namespace

TEST_SUITE("render/video") {
  TEST_CASE("a film of ten frames has ten frames of its size") {
    if (!has_ffmpeg()) return;
    const TemporaryFolder folder;
    const std::string path = folder.file("a: 'film'.mp4");
    const std::string plain = folder.file("film.mp4");
    REQUIRE(write_frames({path, 64, 48, 30}, 10));
    std::filesystem::rename(path, plain);
    CHECK(probe(plain) == "64,48,10");
    std::filesystem::remove(plain);
    CHECK(folder.is_empty());
  }

  TEST_CASE("a gif has its frames, of odd size too") {
    if (!has_ffmpeg()) return;
    const TemporaryFolder folder;
    REQUIRE(write_frames({folder.file("a.gif"), 33, 21, 25}, 6));
    CHECK(probe(folder.file("a.gif")) == "33,21,6");
  }

  TEST_CASE("numbered pictures count from zero and hold their frames") {
    const TemporaryFolder folder;
    REQUIRE(write_frames({folder.file("p_%04d.png"), 5, 3, 30}, 3));
    const auto last = hooke::render::load_image(folder.file("p_0002.png"));
    REQUIRE(last);
    CHECK(last.value() == make_frame(5, 3, 40));
    CHECK(std::filesystem::exists(folder.file("p_0000.png")));
    CHECK_FALSE(std::filesystem::exists(folder.file("p_0003.png")));
  }

  TEST_CASE("sizes and names that the format does not have are errors") {
    const TemporaryFolder folder;
    const auto odd = VideoWriter::create({folder.file("a.mp4"), 63, 48, 30});
    REQUIRE_FALSE(odd);
    CHECK(odd.error().code == ErrorCode::kOutOfRange);
    CHECK(odd.error().message.find("even") != std::string::npos);
    CHECK_FALSE(VideoWriter::create({folder.file("a.avi"), 64, 48, 30}));
    CHECK_FALSE(VideoWriter::create({folder.file("a.png"), 64, 48, 30}));
    CHECK_FALSE(VideoWriter::create({folder.file("a_%s.png"), 64, 48, 30}));
    CHECK_FALSE(VideoWriter::create({folder.file("a_%d_%d.png"), 64, 48, 30}));
    CHECK_FALSE(VideoWriter::create({folder.file("a.mp4"), 0, 48, 30}));
    CHECK_FALSE(VideoWriter::create({folder.file("a.mp4"), 64, 48, 0}));
    const auto nowhere = VideoWriter::create({folder.file("none/a.mp4"), 64, 48, 30});
    REQUIRE_FALSE(nowhere);
    CHECK(nowhere.error().code == ErrorCode::kFileNotWritable);
    CHECK(folder.is_empty());
  }

  TEST_CASE("without ffmpeg a film is an error and leaves no file") {
    const TemporaryFolder folder;
    const ScopedVariable path("PATH", "/nonexistent");
    const auto writer = VideoWriter::create({folder.file("a.mp4"), 64, 48, 30});
    REQUIRE_FALSE(writer);
    CHECK(writer.error().code == ErrorCode::kUnsupported);
    CHECK(folder.is_empty());
  }

  TEST_CASE("when the disk refuses in the middle of a film, the error comes back and the program lives") {
    if (!has_ffmpeg()) return;
    const TemporaryFolder folder;
    const ScopedFileLimit limit(200'000);
    auto writer = VideoWriter::create({folder.file("a.mp4"), 320, 240, 30});
    REQUIRE(writer);
    bool failed = false;
    for (int i = 0; i < 200 && !failed; ++i) failed = !writer.value().add(make_frame(320, 240, i, true));
    CHECK((failed || !writer.value().finish()));
    CHECK_FALSE(writer.value().add(make_frame(320, 240, 0)));
    CHECK_FALSE(writer.value().finish());
    CHECK(folder.is_empty());
  }

  TEST_CASE("a film that is never finished, or has no frame, leaves no file") {
    if (!has_ffmpeg()) return;
    const TemporaryFolder folder;
    {
      auto writer = VideoWriter::create({folder.file("a.mp4"), 64, 48, 30});
      REQUIRE(writer);
      CHECK(writer.value().add(make_frame(64, 48, 9)));
      CHECK_FALSE(writer.value().add(make_frame(64, 46, 9)));
    }
    CHECK(folder.is_empty());
    CHECK_FALSE(write_frames({folder.file("a.mp4"), 64, 48, 30}, 0));
    CHECK(folder.is_empty());
  }
}
