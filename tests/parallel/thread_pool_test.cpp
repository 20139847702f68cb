#include "parallel/thread_pool.h"

#include <doctest/doctest.h>
#include <vector>

namespace hooke::parallel {

TEST_SUITE("parallel/thread_pool") {
  TEST_CASE("every row is visited once, whatever the number of workers") {
    for (const int workers : {1, 2, 3, 8}) {
      ThreadPool pool(workers);
      for (const int count : {0, 1, 15, 16, 17, 1000}) {
        std::vector<int> visits(static_cast<std::size_t>(count), 0);
        for_ranges(pool, count, 16, [&](Range range) {
          CHECK(range.begin % 16 == 0);
          for (int i = range.begin; i < range.end; ++i) ++visits[static_cast<std::size_t>(i)];
        });
        for (const int v : visits) CHECK(v == 1);
      }
    }
  }

  TEST_CASE("every item is done once, whoever does it") {
    for (const int workers : {1, 2, 3, 8}) {
      ThreadPool pool(workers);
      for (const int count : {0, 1, 2, 1000}) {
        std::vector<int> visits(static_cast<std::size_t>(count), 0);
        for_items(pool, count, [&](int i) { ++visits[static_cast<std::size_t>(i)]; });
        for (const int v : visits) CHECK(v == 1);
      }
    }
  }

  TEST_CASE("many short jobs one after another see each other's results") {
    ThreadPool pool(3);
    std::vector<int> value(64, 0);
    for (int round = 0; round < 2000; ++round) {
      for_ranges(pool, 64, 1, [&](Range range) {
        for (int i = range.begin; i < range.end; ++i) value[static_cast<std::size_t>(i)] += round;
      });
    }
    for (const int v : value) CHECK(v == 1999 * 1000);
  }
}

}  // namespace hooke::parallel
