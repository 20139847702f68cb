#include "geometry/solid/parts_listener.h"

namespace hooke::geometry {

namespace {

thread_local PartsListener* listener_of_thread = nullptr;

}  // namespace

PartsListening::PartsListening(PartsListener* listener) : before_(listener_of_thread) {
  listener_of_thread = listener;
}

PartsListening::~PartsListening() {
  listener_of_thread = before_;
}

PartsListener* PartsListening::current() {
  return listener_of_thread;
}

}  // namespace hooke::geometry
