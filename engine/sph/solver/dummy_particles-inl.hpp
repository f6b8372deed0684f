#pragma once

#include <algorithm>
#include <array>
#include <utility>

#include "engine/sph/solver/cluster_bounds-inl.hpp"
#include "engine/sph/solver/dummy_particles.hpp"

namespace sluice {

template <typename T, int Dim>
DummyParticles<T, Dim>::DummyParticles(ThreadTeam& team, const Grid<Dim>& grid,
                                       const MethodN<Dim>& method,
                                       const std::optional<GateMotionN<Dim>>& gate,
                                       const std::vector<VecN<Dim>>& places)
    : count_(places.size()) {
  if (places.empty()) return;
  std::array<std::vector<double>, Dim> position;
  std::vector<double> id(count_);
  for (std::size_t i = 0; i < count_; ++i) {
    append(position, places[i]);
    id[i] = static_cast<double>(i);
  }
  Order order = sort_into_clusters<Dim>(team, grid, spans_of<Dim>(position), id);
  layout_ = std::move(order.layout);
  source_ = std::move(order.source);
  const std::size_t slots = layout_.slots();
  arrays_.resize(slots);
  excess_.resize(slots);
  std::array<std::vector<double>, Dim> slot_position;
  for (std::vector<double>& along : slot_position) along.resize(slots, 0.0);
  std::vector<double> slot_id(slots, kNobody);
  for (std::size_t s = 0; s < slots; ++s) {
    const std::uint32_t i = source_[s];
    if (i == Order::kEmpty) continue;
    for (std::size_t axis = 0; axis < Dim; ++axis) slot_position[axis][s] = position[axis][i];
    slot_id[s] = id[i];
    if (gate && gate->place.contains(places[i])) {
      lifted_.push_back({places[i], s});
    }
  }
  bounds_.assign_origin_cells(team, grid, layout_, spans_of<Dim>(slot_position), slot_id);
  // Empty slots lie on the other side than those of the fluid.
  const double h = method.smoothing_length;
  for (std::size_t s = 0; s < slots; ++s) {
    const bool used = slot_id[s] >= 0.0;
    const VecN<Dim> origin = grid.origin_cell_center(bounds_.origin_cell[s / kCluster]);
    for (std::size_t axis = 0; axis < Dim; ++axis) {
      const double from = origin[static_cast<Eigen::Index>(axis)];
      arrays_.position(axis)[s] =
          static_cast<T>(used ? (slot_position[axis][s] - from) / h : -nowhere(s));
    }
    arrays_.volume()[s] = T{1};
  }
  paths_.resize(slots);
  paths_.begin(arrays_, 0, slots);
  bounds_.resize(layout_);
  bounds_.assign_boxes(0, layout_.clusters(), grid, h, set().paths);
  bounds_.assign_rows(team, layout_);
}

template <typename T, int Dim>
void DummyParticles<T, Dim>::sum_pressures(ThreadTeam& team, const MethodN<Dim>& method,
                                           const Sweeps<T, Dim>& sweeps,
                                           const TermConstants<T, Dim>& constants,
                                           const PairView<T, Dim>& fluid, const PairList& list) {
  team.run(list.chunks.size(), [&](std::size_t chunk) {
    SweepTask<T, Dim> task;
    task.self = view();
    task.fluid = fluid;
    task.to_fluid = &list.chunks[chunk];
    task.first_cluster = layout_.chunk_begin(chunk);
    task.clusters = layout_.chunk_begin(chunk + 1) - task.first_cluster;
    task.constants = &constants;
    task.sums = excess_.data();
    sweeps.wall_pressure(task);
    const std::size_t begin = kCluster * task.first_cluster;
    for (std::size_t s = begin; s < begin + kCluster * task.clusters; ++s) {
      T excess = excess_[s];
      if (method.wall_pressure == WallPressure::clamped) excess = std::max(excess, T{0});
      const T volume = T{1} / (T{1} + excess);
      arrays_.excess()[s] = excess;
      arrays_.volume()[s] = volume;
      arrays_.pressure_term()[s] = excess * volume * volume;
    }
  });
}

template <typename T, int Dim>
void DummyParticles<T, Dim>::lift(const std::optional<GateMotionN<Dim>>& gate, double time) {
  std::erase_if(lifted_, [&](const GateParticle& p) {
    if (!gate->has_passed(p.place, time)) return false;
    for (std::size_t axis = 0; axis < Dim; ++axis) {
      arrays_.position(axis)[p.slot] = static_cast<T>(-nowhere(p.slot));
    }
    paths_.begin(arrays_, p.slot, p.slot + 1);
    arrays_.excess()[p.slot] = arrays_.pressure_term()[p.slot] = T{0};
    arrays_.volume()[p.slot] = T{1};
    return true;
  });
}

template <typename T, int Dim>
std::vector<double> DummyParticles<T, Dim>::pressures(const MethodN<Dim>& method) const {
  std::vector<double> result(count_, 0.0);
  const double scale = method.reference_density * method.sound_speed * method.sound_speed;
  for (std::size_t s = 0; s < layout_.slots(); ++s) {
    if (source_[s] == Order::kEmpty) continue;
    result[source_[s]] = static_cast<double>(arrays_.value(PairFields<Dim>::excess, s)) * scale;
  }
  return result;
}

}  // namespace sluice
