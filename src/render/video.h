#pragma once

#include "hooke/result.h"

#include "render/image.h"

#include <memory>
#include <string>

namespace hooke::render {

struct VideoOptions {
  /// Ends in .mp4 or .gif; or in .png with one %0Nd for the frame number, counted from 0.
  std::string path;
  /// Size [px]; even for .mp4, whose colors are stored for 2 x 2 pixels.
  int width = 1280;
  int height = 720;
  int frames_per_second = 60;  ///< 1 to 240. A .gif shows at most 50; further frames are dropped.
};

struct VideoData;

/// Writes frames to a film by the program `ffmpeg`, or to numbered pictures. A film appears under its name
/// only when it is complete: a film that fails or is never finished leaves no file. Numbered pictures appear
/// one by one.
class VideoWriter {
 public:
  /// Starts a film. The Error is kUnsupported if there is no ffmpeg, kOutOfRange for a size or name that the
  /// format does not have, and kFileNotWritable if the folder refuses.
  static Result<VideoWriter> create(const VideoOptions& options);

  VideoWriter(VideoWriter&&) noexcept;
  VideoWriter& operator=(VideoWriter&&) noexcept;
  ~VideoWriter();

  /// Adds the next frame: RGB, of the film's size. A frame of another size is refused and may be followed by
  /// others, as may a numbered picture that was not written; when ffmpeg has failed, every further call gives
  /// an Error.
  Result<void> add(const Image& frame);

  /// Waits until the film is written and gives it its name. Call it once, last.
  Result<void> finish();

 private:
  explicit VideoWriter(std::unique_ptr<VideoData> data);

  std::unique_ptr<VideoData> data_;
};

}  // namespace hooke::render
