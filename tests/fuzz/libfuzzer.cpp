/// An entry point for libFuzzer, of the loader HOOKE_LOADER. What a check finds ends the process, as a crash
/// does.

#include "fuzz/target.h"

#include <cstdio>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

/// Text, or bytes: what the check takes.
template <class Input>
void call(void (*check)(Input), const std::uint8_t* data, std::size_t size) {
  using Item = typename Input::value_type;
  check(Input(reinterpret_cast<const Item*>(data), size));
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    call(hooke::fuzz::HOOKE_LOADER, data, size);
  } catch (const hooke::fuzz::Failure& failure) {
    std::fprintf(stderr, "FAILED: %s\n", failure.what());
    std::abort();
  }
  return 0;
}
