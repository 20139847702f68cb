/// An entry point for libFuzzer, of the loader HOOKE_LOADER. What a check finds ends the process, as a crash
/// does.

#include "fuzz/target.h"

#include <cstdio>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

void call(void (*check)(std::string), const std::uint8_t* data, std::size_t size) {
  check({reinterpret_cast<const char*>(data), size});
}

void call(void (*check)(std::span<const std::byte>), const std::uint8_t* data, std::size_t size) {
  check({reinterpret_cast<const std::byte*>(data), size});
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
