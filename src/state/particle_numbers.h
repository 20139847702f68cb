#pragma once

#include "state/tables.h"

#include <cstdint>
#include <span>

namespace hooke::state {

/// Calls `visit` with each number of a particle that pins and hooks hold, and that stands in the tables' rows
/// from those of `from` on: what may change when particles are removed or inserted before them. Contacts are
/// left to who calls it, because the next step finds them again.
template <class Visit>
void for_each_particle_number(Tables& t, const Deformable& from, Visit visit) {
  const auto behind = [](auto& column, Rows rows) { return std::span(column).subspan(rows.first); };
  for (std::uint32_t& p : behind(t.springs.particle_a, from.springs)) visit(p);
  for (std::uint32_t& p : behind(t.springs.particle_b, from.springs)) visit(p);
  for (Bends::Stencil& s : behind(t.bends.stencil, from.bends)) {
    for (std::uint32_t* p : {&s.edge_a, &s.edge_b, &s.wing_a, &s.wing_b}) visit(*p);
  }
  for (Triangles::Corners& c : behind(t.triangles.corners, from.triangles)) {
    for (std::uint32_t* p : {&c.a, &c.b, &c.c}) visit(*p);
  }
  for (Tetrahedra::Corners& c : behind(t.tetrahedra.corners, from.tetrahedra)) {
    for (std::uint32_t* p : {&c.a, &c.b, &c.c, &c.d}) visit(*p);
  }
  for (Pin& pin : t.pins) visit(pin.particle);
  for (Hook& hook : t.hooks) {
    for (HookPlace* end : {&hook.a, &hook.b}) {
      for (std::uint32_t i = 0; i < end->particle_count; ++i) visit(end->particle[i]);
    }
  }
}

}  // namespace hooke::state
