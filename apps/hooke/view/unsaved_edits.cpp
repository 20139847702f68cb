#include "hooke/view/unsaved_edits.h"

#include "hooke/session/session.h"

#include "process/new_file.h"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <utility>

namespace hooke::app {

namespace {

const Session* watched = nullptr;

void keep_edits() {
  const Session* session = std::exchange(watched, nullptr);
  if (session == nullptr) return;
  const auto view = session->view();
  if (!view->edited || !view->document) return;
  const std::filesystem::path scene = view->document->scene.path;
  const std::string kept = (scene.parent_path() / (scene.stem().string() + "-unsaved.json")).string();
  const Result<void> written = process::write_file(kept, view->document->text);
  if (!written) {
    std::fprintf(stderr, "hooke view: edits are lost: %s\n", to_line(written.error()).c_str());
    return;
  }
  std::fprintf(stderr, "hooke view: edits were not saved; they are kept in '%s'\n", kept.c_str());
}

}  // namespace

UnsavedEdits::UnsavedEdits(const Session& session) {
  static const int registered = std::atexit(keep_edits);
  watched = registered == 0 ? &session : nullptr;
}

UnsavedEdits::~UnsavedEdits() {
  keep_edits();
}

void UnsavedEdits::forget() {
  watched = nullptr;
}

}  // namespace hooke::app
