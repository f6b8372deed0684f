#pragma once

#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "engine/sph/method/removed.hpp"
#include "engine/sph/solver/engine_of.hpp"
#include "engine/sph/solver/term_constants.hpp"
#include "engine/sph/stability/neighbour_count-inl.hpp"

namespace sluice {
namespace engine_order {

inline constexpr double kListSlack = 1e-3;  // lists are longer by more than any rounding

// The order in memory is state: when it is renewed is a function of the step alone.
inline constexpr double kOrderLifetime = 30.0;  // h/c at the largest step

// Solids are looked into by step as well: sound goes not much farther meanwhile than a solid must
// be thick.
inline constexpr double kSolidInterval = 4.0;  // h/c at the largest step

/// Whether it is the step for what is done every so many h/c at the largest step.
inline bool is_step_for(std::uint64_t step, double interval, double courant) {
  const double steps = std::max(1.0, std::round(interval / courant));
  return step % static_cast<std::uint64_t>(steps) == 0;
}

}  // namespace engine_order

template <typename T, int Dim>
bool Engine<T, Dim>::somebody_in_a_solid() {
  struct Seen {
    bool somebody = false;
    void merge(const Seen& other) { somebody |= other.somebody; }
  };
  return for_chunks<Seen>([&](const Span& p, Seen& seen) {
           for (std::size_t s = p.begin; s < p.end; ++s) {
             seen.somebody |= p.id[s] >= 0.0 && domain_.in_solid(p.place(s), facts_.time);
           }
         })
      .somebody;
}

/// Whether particles are to be removed, or their order has served its time.
template <typename T, int Dim>
bool Engine<T, Dim>::order_due() {
  if (domain_.in_solid &&
      engine_order::is_step_for(facts_.step_count, engine_order::kSolidInterval, method_.courant)) {
    leaving_ |= somebody_in_a_solid();
  }
  return leaving_ || engine_order::is_step_for(facts_.step_count, engine_order::kOrderLifetime,
                                               method_.courant);
}

template <typename T, int Dim>
void Engine<T, Dim>::advance_paths(double duration) {
  paths_.age += duration * method_.sound_speed / method_.smoothing_length;
}

template <typename T, int Dim>
void Engine<T, Dim>::compare_with_paths(const Span& p, Motion& seen) {
  sweeps_.updates.compare(p, pairs_, paths_.view(), static_cast<T>(paths_.age), seen);
}

/// New lists where the old ones no longer hold.
template <typename T, int Dim>
void Engine<T, Dim>::keep_lists(const Motion& seen) {
  if (seen.expired) {
    list_lifetime_.expired(paths_.age);
  } else if (paths_.age > list_lifetime_.value()) {
    list_lifetime_.served();
  } else {
    return;
  }
  const PassClock clock(seconds_of(Pass::sort));
  make_lists();
}

template <typename T, int Dim>
void Engine<T, Dim>::sort() {
  const PassClock clock(seconds_of(Pass::sort));
  const bool fewer = leaving_ && remove();
  reorder(sort_into_clusters<Dim>(team_, grid_, spans_of<Dim>(particles_.position), particles_.id));
  particles_.position_sorted = particles_.position;
  bind();
  count_neighbours();
  ++facts_.sort_count;
  // From here on all is as a solver finds it that goes on with this state: the next step sees wall
  // pressures summed in this order, and nothing of what left.
  if (method_.integrator == Integrator::kick_drift_kick) sum_wall_pressure();
  if (fewer) measure();
}

/// Takes out who is no particle of the fluid any more; whether there was any.
template <typename T, int Dim>
bool Engine<T, Dim>::remove() {
  const std::size_t before = facts_.particle_count;
  for (std::size_t s = 0; s < particles_.size(); ++s) {
    if (particles_.id[s] < 0.0) continue;
    const auto cause = cause_to_remove(method_, domain_, particles_, s, facts_.time);
    if (!cause) continue;
    facts_.removed.push_back(record_of(particles_, s, *cause, facts_.step_count, facts_.time));
    particles_.id[s] = kNobody;
    --facts_.particle_count;
  }
  return facts_.particle_count < before;
}

template <typename T, int Dim>
void Engine<T, Dim>::reorder(Order order) {
  const Layout& next = order.layout;
  std::vector<double> moved;  // each field goes where the one before was
  for (const FieldN<Dim>& field : FieldList<Dim>::fields) {
    if (!carries(method_.integrator, field)) continue;
    std::vector<double>& values = field.values.of(particles_);
    const double empty = field.empty == EmptySlot::nobody ? kNobody : 0.0;
    const double scale = field.empty == EmptySlot::nowhere ? method_.smoothing_length : 0.0;
    resize_closely(moved, next.slots());
    team_.run(next.chunks(), [&](std::size_t chunk) {
      const std::size_t end = kCluster * next.chunk_begin(chunk + 1);
      for (std::size_t s = kCluster * next.chunk_begin(chunk); s < end; ++s) {
        moved[s] =
            order.source[s] != Order::kEmpty ? values[order.source[s]] : empty + scale * nowhere(s);
      }
    });
    values.swap(moved);
  }
  layout_ = std::move(order.layout);
}

/// Everything that follows from the order: origin cells, pair arrays and lists.
template <typename T, int Dim>
void Engine<T, Dim>::bind() {
  const std::size_t slots = layout_.slots();
  bounds_.assign_origin_cells(team_, grid_, layout_, spans_of<Dim>(particles_.position_sorted),
                              particles_.id);
  scales_ = scales();
  pairs_.resize(slots);
  if (keeps_diffused(method_)) pairs_.keep_diffused();
  paths_.resize(slots);
  for_chunks([&](const Span& p, Motion&) { write_pairs(p); });
  make_lists();
}

/// Pair lists for paths that begin here and now.
template <typename T, int Dim>
void Engine<T, Dim>::make_lists() {
  paths_.age = 0.0;
  paths_.skin = skin_for<T>(list_lifetime_.value());
  bounds_.resize(layout_);
  for_chunks([&](const Span& p, Motion&) {
    paths_.begin(pairs_, p.begin, p.end);
    bounds_.assign_boxes(p.begin / kCluster, p.end / kCluster, grid_, method_.smoothing_length,
                         paths_.view());
  });
  bounds_.assign_rows(team_, layout_);
  const PairRange<T, Dim> range{static_cast<T>(method_.support_ratio() + engine_order::kListSlack),
                                constants_.origin_shift, grid_.has_one_origin_cell()};
  const PairSet<T, Dim> fluid{layout_, bounds_, paths_.view()};
  const PairSet<T, Dim> wall = walls_.set();
  const std::array lists{NewPairList<T, Dim>{&fluid, &fluid, &fluid_to_fluid_},
                         NewPairList<T, Dim>{&fluid, &wall, &fluid_to_wall_},
                         NewPairList<T, Dim>{&wall, &fluid, &wall_to_fluid_}};
  build_pair_lists<T, Dim>(team_, sweeps_, range, std::span(lists).first(walls_.empty() ? 1 : 3));
  const Blocks& largest = method_.integrator == Integrator::modified_leap_frog ? kRateSums<Dim>
                          : method_.shifting ? kDensityAndShiftingSums<Dim>
                                             : kAccelerationSums<Dim>;
  sums_.place(fluid_to_fluid_, layout_.chunk, largest.stride);
}

template <typename T, int Dim>
void Engine<T, Dim>::count_neighbours() {
  facts_.extremes.max_neighbours =
      most_neighbours(team_, layout_, fluid_to_fluid_, sums_, pairs_, method_.support_ratio());
}

}  // namespace sluice
