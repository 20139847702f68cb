#include "hooke/session/timeline.h"

#include <algorithm>
#include <utility>

namespace hooke::app {

namespace {

/// A timeline keeps at least this many moments, however large they are: the first and the last.
constexpr std::size_t kFewestMoments = 2;

bool is_for_undo(const Moment& moment) {
  return !moment.before.empty();
}

}  // namespace

bool Timeline::is_due(std::uint64_t step) const {
  return step % interval_ == 0 && (moments_.empty() || moments_.back().step < step);
}

void Timeline::add(Moment moment) {
  bytes_ += moment.snapshot.bytes();
  moments_.push_back(std::move(moment));
  while (bytes_ > budget_ && moments_.size() > kFewestMoments) thin_out();
}

void Timeline::thin_out() {
  const std::size_t before = moments_.size();
  // Zero is a multiple of every interval: of the moments at the start only the first one stays for good.
  const std::uint64_t start = moments_.front().step;
  const auto goes = [&](const Moment& moment) {
    const bool is_first = &moment == moments_.data();
    const bool is_last = &moment == &moments_.back();
    const bool is_between = moment.step == start || moment.step % (2 * interval_) != 0;
    return !is_first && !is_last && !is_for_undo(moment) && is_between;
  };
  std::vector<Moment> kept;
  for (Moment& moment : moments_) {
    if (!goes(moment)) kept.push_back(std::move(moment));
  }
  moments_ = std::move(kept);
  const bool only_undo = std::all_of(moments_.begin() + 1, moments_.end() - 1, is_for_undo);
  if (moments_.size() < before || !only_undo) {
    interval_ *= 2;
  } else if (!drop_oldest_undo()) {
    moments_.erase(moments_.begin() + 1, moments_.end() - 1);
  }
  count_bytes();
}

bool Timeline::drop_oldest_undo() {
  const auto oldest = std::find_if(moments_.begin() + 1, moments_.end() - 1, is_for_undo);
  if (oldest == moments_.end() - 1) return false;
  moments_.erase(oldest);
  return true;
}

void Timeline::count_bytes() {
  bytes_ = 0;
  for (const Moment& moment : moments_) bytes_ += moment.snapshot.bytes();
}

const Moment* Timeline::find(std::uint64_t step) const {
  const auto after = std::upper_bound(moments_.begin(), moments_.end(), step,
                                      [](std::uint64_t s, const Moment& m) { return s < m.step; });
  return after == moments_.begin() ? nullptr : &*(after - 1);
}

const Moment* Timeline::find_undo(std::size_t actions) const {
  const auto found = std::find_if(moments_.rbegin(), moments_.rend(), [&](const Moment& moment) {
    return is_for_undo(moment) && moment.actions < actions;
  });
  return found == moments_.rend() ? nullptr : &*found;
}

std::size_t Timeline::undo_count(std::size_t actions) const {
  return static_cast<std::size_t>(std::count_if(moments_.begin(), moments_.end(), [&](const Moment& moment) {
    return is_for_undo(moment) && moment.actions < actions;
  }));
}

void Timeline::cut(std::uint64_t step, std::size_t actions) {
  log_.erase(log_.begin() + static_cast<std::ptrdiff_t>(std::min(actions, log_.size())), log_.end());
  std::erase_if(moments_,
                [&](const Moment& moment) { return moment.step > step || moment.actions > actions; });
  count_bytes();
}

std::vector<LoggedAction> Timeline::actions_from(std::size_t actions) const {
  return {log_.begin() + static_cast<std::ptrdiff_t>(std::min(actions, log_.size())), log_.end()};
}

void Timeline::forget_undo(std::size_t actions) {
  for (Moment& moment : moments_) {
    if (moment.actions >= actions) moment.before.clear();
  }
}

}  // namespace hooke::app
