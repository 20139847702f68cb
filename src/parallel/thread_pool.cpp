#include "parallel/thread_pool.h"

#include "base/float_environment.h"

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace hooke::parallel {

namespace {

/// Spinning lasts about 50 microseconds: longer than the gap between two stages of a step, shorter than a
/// scheduler's time slice. With more workers than processors a spinning thread only keeps another from its
/// work.
int spins_for(int workers) {
  constexpr int kSpins = 4000;
  return workers <= static_cast<int>(std::thread::hardware_concurrency()) ? kSpins : 1;
}

inline void pause_briefly() {
#if defined(__x86_64__) || defined(_M_X64)
  __builtin_ia32_pause();
#else
  std::this_thread::yield();
#endif
}

}  // namespace

struct ThreadPool::Shared {
  explicit Shared(int workers) : spins(spins_for(workers)), parts(workers) {}

  /// `begun` is the number of the last job of which some thread has begun this part.
  struct alignas(64) Part {
    std::atomic<std::uint64_t> begun{0};
  };

  const int spins;
  std::vector<Part> parts;
  std::atomic<std::uint64_t> job_number{0};
  std::atomic<int> unfinished{0};
  std::atomic<bool> stopping{false};
  std::atomic<int> sleepers{0};
  void (*job)(void*, int) = nullptr;
  std::exception_ptr failure;  ///< Exception of the first part that failed; guarded by `mutex`.
  void* context = nullptr;
  std::mutex mutex;
  std::condition_variable wake;
  std::vector<std::thread> threads;

  void wait_for_job(std::uint64_t last) {
    for (int i = 0; i < spins; ++i) {
      if (job_number.load(std::memory_order_acquire) != last) return;
      pause_briefly();
    }
    std::unique_lock<std::mutex> lock(mutex);
    sleepers.fetch_add(1);
    wake.wait(lock, [&] { return job_number.load(std::memory_order_acquire) != last; });
    sleepers.fetch_sub(1);
  }

  /// Does the parts of a job that no thread has begun, its own part first. So a part whose thread the system
  /// has not scheduled is done by another thread. No part of an older job can be begun any more, because a
  /// job ends only when all its parts are done.
  void do_parts(std::uint64_t number, int own) {
    const int count = static_cast<int>(parts.size());
    for (int i = 0; i < count; ++i) {
      const int part = own + i < count ? own + i : own + i - count;
      std::uint64_t before = number - 1;
      if (!parts[part].begun.compare_exchange_strong(before, number, std::memory_order_acq_rel)) continue;
      try {
        job(context, part);
      } catch (...) {
        const std::lock_guard<std::mutex> lock(mutex);
        if (!failure) failure = std::current_exception();
      }
      unfinished.fetch_sub(1, std::memory_order_release);
    }
  }

  void work(int own) {
    std::uint64_t last = 0;
    for (;;) {
      wait_for_job(last);
      last = job_number.load(std::memory_order_acquire);
      if (stopping.load(std::memory_order_acquire)) return;
      const base::FloatEnvironment environment;
      do_parts(last, own);
    }
  }

  void publish() {
    {
      // The lock orders this with a worker that is about to sleep: it either sees the new number or is woken.
      const std::lock_guard<std::mutex> lock(mutex);
      job_number.fetch_add(1, std::memory_order_release);
    }
    if (sleepers.load() > 0) wake.notify_all();
  }

  void stop() {
    stopping.store(true, std::memory_order_release);
    publish();
    for (std::thread& thread : threads) thread.join();
  }
};

ThreadPool::ThreadPool(int workers) : workers_(workers), shared_(std::make_unique<Shared>(workers)) {
  try {
    for (int part = 1; part < workers_; ++part)
      shared_->threads.emplace_back([shared = shared_.get(), part] { shared->work(part); });
  } catch (...) {
    shared_->stop();  // A thread that still runs when it is destroyed ends the program.
    throw;
  }
}

ThreadPool::~ThreadPool() {
  shared_->stop();
}

void ThreadPool::run(void (*job)(void*, int), void* context) {
  Shared& shared = *shared_;
  shared.job = job;
  shared.context = context;
  shared.unfinished.store(workers_, std::memory_order_relaxed);
  shared.publish();
  shared.do_parts(shared.job_number.load(std::memory_order_relaxed), 0);
  for (int i = 0; shared.unfinished.load(std::memory_order_acquire) > 0; ++i) {
    if (i < shared.spins) {
      pause_briefly();
    } else {
      std::this_thread::yield();
    }
  }
  if (shared.failure) std::rethrow_exception(std::exchange(shared.failure, nullptr));
}

}  // namespace hooke::parallel
