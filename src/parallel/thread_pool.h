#pragma once

#include "parallel/range.h"

#include <atomic>
#include <memory>
#include <type_traits>

namespace hooke::parallel {

/// The pool holds threads that wait for short jobs. They spin for some tens of microseconds after a job, then
/// sleep.
///
/// The split of a job depends only on its size and the number of workers. Kernels write disjoint rows, so
/// results depend on neither.
class ThreadPool {
 public:
  /// `workers` counts the calling thread, so that 1 starts no thread. It must be in [1, 64].
  explicit ThreadPool(int workers);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  [[nodiscard]] int workers() const { return workers_; }

  /// Calls `job(context, part)` once for each part in [0, workers), on whichever thread is free. Each thread
  /// prefers the same part every time. Returns when all parts are done; if some threw, the exception of the
  /// first is thrown then. It must not be called from within a job.
  void run(void (*job)(void* context, int part), void* context);

 private:
  struct Shared;
  int workers_;
  std::unique_ptr<Shared> shared_;
};

template <class Kernel>
void call_kernel(Kernel& kernel, Range range, [[maybe_unused]] int part) {
  if constexpr (std::is_invocable_v<Kernel&, Range, int>) {
    kernel(range, part);
  } else {
    kernel(range);
  }
}

/// Calls `kernel(range)`, or `kernel(range, part)`, over disjoint ranges that cover [0, count). Ranges start
/// at multiples of `grain`, the size below which a job is not worth splitting. Kernels of one call must not
/// write a row that another range reads. `part`, in [0, workers), is the number of the range. A part has the
/// same rows every time, whichever thread does it, so memory may be kept per part.
template <class Kernel>
void for_ranges(ThreadPool& pool, int count, int grain, Kernel&& kernel) {
  if (count <= 0) return;
  const int blocks = (count + grain - 1) / grain;
  if (pool.workers() == 1 || blocks == 1) return call_kernel(kernel, {0, count}, 0);
  struct Context {
    std::remove_reference_t<Kernel>* kernel;
    int count, grain, blocks, workers;
  } context{&kernel, count, grain, blocks, pool.workers()};
  pool.run(
      [](void* data, int part) {
        const auto& c = *static_cast<Context*>(data);
        const auto edge = [&c](int i) {
          const auto block = static_cast<int>(static_cast<long long>(c.blocks) * i / c.workers);
          const long long row = static_cast<long long>(block) * c.grain;
          return row < c.count ? static_cast<int>(row) : c.count;
        };
        const Range range{edge(part), edge(part + 1)};
        if (range.begin < range.end) call_kernel(*c.kernel, range, part);
      },
      &context);
}

/// Calls `kernel(item)` for each item in [0, count); each thread takes the next item that is left. Use it for
/// items whose costs differ much. Kernels of one call must not write what another item reads. Memory that is
/// kept from call to call must belong to items, not to threads.
template <class Kernel>
void for_items(ThreadPool& pool, int count, Kernel&& kernel) {
  if (pool.workers() == 1 || count <= 1) {
    for (int item = 0; item < count; ++item) kernel(item);
    return;
  }
  struct Context {
    std::remove_reference_t<Kernel>* kernel;
    int count;
    std::atomic<int> next{0};
  } context{&kernel, count};
  pool.run(
      [](void* data, int) {
        auto& c = *static_cast<Context*>(data);
        for (int item = c.next.fetch_add(1); item < c.count; item = c.next.fetch_add(1)) (*c.kernel)(item);
      },
      &context);
}

}  // namespace hooke::parallel
