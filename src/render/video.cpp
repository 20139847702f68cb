#include "render/video.h"

#include "process/child.h"
#include "process/new_file.h"

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <optional>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>
#include <vector>

namespace hooke::render {

namespace {

using process::Descriptor;

enum class Format { kMp4, kGif, kPictures };

struct MessageCloser {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

bool ends_in(const std::string& text, const std::string& ending) {
  return text.size() > ending.size() && text.compare(text.size() - ending.size(), ending.size(), ending) == 0;
}

/// This is the name of a numbered picture before and after its number.
struct NumberedName {
  std::string before;
  std::size_t digits = 0;
  std::string after;
};

/// Accepts only %d, %Nd and %0Nd with N of one digit. The name comes from a user and never reaches printf.
std::optional<NumberedName> parse_numbered(const std::string& path) {
  const std::size_t start = path.find('%');
  if (start == std::string::npos || path.find('%', start + 1) != std::string::npos) return std::nullopt;
  std::size_t at = start + 1;
  if (at < path.size() && path[at] == '0') ++at;
  NumberedName name;
  if (at < path.size() && path[at] >= '1' && path[at] <= '9') {
    name.digits = static_cast<std::size_t>(path[at++] - '0');
  }
  if (at >= path.size() || path[at] != 'd') return std::nullopt;
  name.before = path.substr(0, start);
  name.after = path.substr(at + 1);
  return name;
}

std::string numbered(const NumberedName& name, int number) {
  const std::string digits = std::to_string(number);
  const std::string zeros(name.digits > digits.size() ? name.digits - digits.size() : 0, '0');
  return name.before + zeros + digits + name.after;
}

Result<Format> format_of(const VideoOptions& options) {
  const std::string size = std::to_string(options.width) + " x " + std::to_string(options.height);
  if (options.width < 1 || options.height < 1 || options.width > 8192 || options.height > 8192) {
    return Error{ErrorCode::kOutOfRange, options.path, size + " pixels; each side must be 1 to 8192"};
  }
  if (options.frames_per_second < 1 || options.frames_per_second > 240) {
    return Error{ErrorCode::kOutOfRange, options.path,
                 std::to_string(options.frames_per_second) + " frames per second; 1 to 240 are accepted"};
  }
  if (ends_in(options.path, ".gif")) return Format::kGif;
  if (ends_in(options.path, ".mp4")) {
    if (options.width % 2 == 0 && options.height % 2 == 0) return Format::kMp4;
    return Error{ErrorCode::kOutOfRange, options.path,
                 size + " pixels; both sides must be even for .mp4, for example " +
                     std::to_string(options.width + options.width % 2) + " x " +
                     std::to_string(options.height + options.height % 2)};
  }
  if (ends_in(options.path, ".png") && parse_numbered(options.path)) return Format::kPictures;
  return Error{ErrorCode::kOutOfRange, options.path,
               "the name must end in .mp4, .gif, %04d.png, or .png for one picture"};
}

/// Returns the words that start ffmpeg. The film goes to standard output by a file name, because the encoder
/// seeks back in it and reads it again.
std::vector<std::string> ffmpeg_arguments(const VideoOptions& options, Format format) {
  std::vector<std::string> words = {"ffmpeg", "-nostdin", "-hide_banner", "-loglevel", "error", "-y"};
  const std::string size = std::to_string(options.width) + "x" + std::to_string(options.height);
  const std::string rate = std::to_string(options.frames_per_second);
  words.insert(words.end(),
               {"-f", "rawvideo", "-pix_fmt", "rgb24", "-s", size, "-r", rate, "-i", "pipe:0", "-an"});
  if (format == Format::kMp4) {
    words.insert(words.end(), {"-vf",
                               "scale=out_color_matrix=bt709:out_range=tv",
                               "-c:v",
                               "libx264",
                               "-preset",
                               "veryfast",
                               "-crf",
                               "18",
                               "-pix_fmt",
                               "yuv420p",
                               "-colorspace",
                               "bt709",
                               "-color_primaries",
                               "bt709",
                               "-color_trc",
                               "bt709",
                               "-color_range",
                               "tv",
                               "-movflags",
                               "+faststart",
                               "-f",
                               "mp4"});
  } else {
    // Delays are hundredths of a second, and browsers slow down anything below two.
    const std::string fewer = options.frames_per_second > 50 ? "fps=50," : "";
    words.insert(words.end(), {"-filter_complex",
                               fewer + "split[a][b];[a]palettegen=stats_mode=diff[p];"
                                       "[b][p]paletteuse=dither=bayer:bayer_scale=4:diff_mode=rectangle",
                               "-f", "gif"});
  }
  words.emplace_back("file:/dev/fd/1");
  return words;
}

}  // namespace

struct VideoData {
  VideoOptions options;
  Format format = Format::kMp4;
  NumberedName name;                     ///< Set for numbered pictures.
  std::optional<process::NewFile> film;  ///< The file that ffmpeg writes.
  Descriptor input;                      ///< This program's end of ffmpeg's input.
  std::unique_ptr<std::FILE, MessageCloser> messages;
  process::Child ffmpeg;
  int frame_count = 0;
  bool failed = false;

  VideoData() = default;
  VideoData(const VideoData&) = delete;
  VideoData& operator=(const VideoData&) = delete;
  ~VideoData() { abandon(); }

  /// Ends ffmpeg, if it runs, and removes what it wrote.
  void abandon() {
    input.close();
    ffmpeg.kill();
    film.reset();
  }

  /// Waits for ffmpeg; returns why it failed, or nothing if it ended without an error.
  std::optional<std::string> wait_for_end() {
    const int status = ffmpeg.wait();
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return {};
    std::string why = read_messages();
    if (!why.empty()) return why;
    if (WIFSIGNALED(status)) return "signal " + std::string(::strsignal(WTERMSIG(status)));
    return "exit status " + std::to_string(WEXITSTATUS(status));
  }

  /// Returns the beginning of ffmpeg's messages.
  std::string read_messages() {
    std::array<char, 400> text{};
    std::rewind(messages.get());
    const std::size_t size = std::fread(text.data(), 1, text.size(), messages.get());
    std::string result(text.data(), size);
    while (!result.empty() && (result.back() == '\n' || result.back() == '\r')) result.pop_back();
    return result;
  }

  Error fail(ErrorCode code, const std::string& message) {
    failed = true;
    abandon();
    return {code, options.path, message};
  }
};

namespace {

Result<void> start_ffmpeg(VideoData& data) {
  data.messages.reset(std::tmpfile());
  if (!data.messages) return data.fail(ErrorCode::kFileNotWritable, "no room for temporary files");
  auto film = process::NewFile::create(data.options.path);
  if (!film) return data.fail(film.error().code, film.error().message);
  data.film.emplace(std::move(*film));

  // This is a socket and not a pipe, because a write to a socket can be told not to raise SIGPIPE when ffmpeg
  // has ended.
  std::array<int, 2> ends = {-1, -1};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    return data.fail(ErrorCode::kUnsupported, std::strerror(errno));
  }
  data.input = Descriptor(ends[0]);
  const Descriptor theirs(ends[1]);
  auto started = process::Child::start(
      ffmpeg_arguments(data.options, data.format),
      {.input = theirs.number(), .output = data.film->number(), .error = ::fileno(data.messages.get())});
  if (!started) {
    return data.fail(ErrorCode::kUnsupported, "cannot start the program ffmpeg: " + started.error().message +
                                                  " (Debian: package ffmpeg)");
  }
  data.ffmpeg = std::move(started).value();
  return {};
}

bool send_all(int socket, const std::uint8_t* bytes, std::size_t count) {
  while (count > 0) {
    const ssize_t sent = ::send(socket, bytes, count, MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return false;
    bytes += sent;
    count -= static_cast<std::size_t>(sent);
  }
  return true;
}

}  // namespace

VideoWriter::VideoWriter(std::unique_ptr<VideoData> data) : data_(std::move(data)) {}
VideoWriter::VideoWriter(VideoWriter&&) noexcept = default;
VideoWriter& VideoWriter::operator=(VideoWriter&&) noexcept = default;
VideoWriter::~VideoWriter() = default;

Result<VideoWriter> VideoWriter::create(const VideoOptions& options) {
  const auto format = format_of(options);
  if (!format) return format.error();
  auto data = std::make_unique<VideoData>();
  data->options = options;
  data->format = format.value();
  if (data->format == Format::kPictures) {
    data->name = parse_numbered(options.path).value_or(NumberedName{});
  } else {
    const auto started = start_ffmpeg(*data);
    if (!started) return started.error();
  }
  return VideoWriter(std::move(data));
}

Result<void> VideoWriter::add(const Image& frame) {
  VideoData& data = *data_;
  if (data.failed) return Error{ErrorCode::kFileNotWritable, data.options.path, "the film has failed before"};
  if (!is_consistent(frame) || frame.channels != 3 || frame.width != data.options.width ||
      frame.height != data.options.height) {
    return Error{ErrorCode::kOutOfRange, data.options.path,
                 "frame " + std::to_string(data.frame_count) + " is not RGB of the film's size"};
  }
  const int number = data.frame_count++;
  if (data.format == Format::kPictures) return write_png(frame, numbered(data.name, number));
  if (send_all(data.input.number(), frame.pixels.data(), frame.pixels.size())) return {};
  data.input.close();
  const std::string why = data.wait_for_end().value_or("it says no reason");
  return data.fail(ErrorCode::kFileNotWritable, "ffmpeg ended early: " + why);
}

Result<void> VideoWriter::finish() {
  VideoData& data = *data_;
  if (data.failed) return Error{ErrorCode::kFileNotWritable, data.options.path, "the film has failed before"};
  if (data.frame_count == 0) return data.fail(ErrorCode::kOutOfRange, "a film needs at least one frame");
  data.failed = true;  // Nothing can be added from here on.
  if (data.format == Format::kPictures) return {};
  data.input.close();
  if (const auto why = data.wait_for_end())
    return data.fail(ErrorCode::kFileNotWritable, "ffmpeg failed: " + *why);
  const auto named = data.film->finish();
  if (!named) return data.fail(named.error().code, named.error().message);
  return {};
}

}  // namespace hooke::render
