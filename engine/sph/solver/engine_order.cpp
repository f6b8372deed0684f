#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "engine/sph/method/removed.hpp"
#include "engine/sph/solver/engine_of.hpp"
#include "engine/sph/solver/term_constants.hpp"
#include "engine/sph/stability/neighbour_count.hpp"

namespace sluice {
namespace {

constexpr double kListSlack = 1e-3;  // lists are longer by more than any rounding

// The order in memory is state: when it is renewed is a function of the step alone.
constexpr double kOrderLifetime = 30.0;  // h/c at the largest step

// Solids are looked into by step as well: sound goes not much farther meanwhile than a solid must
// be thick.
constexpr double kSolidInterval = 4.0;  // h/c at the largest step

/// Whether it is the step for what is done every so many h/c at the largest step.
bool is_step_for(std::uint64_t step, double interval, double courant) {
  const double steps = std::max(1.0, std::round(interval / courant));
  return step % static_cast<std::uint64_t>(steps) == 0;
}

}  // namespace

template <typename T>
bool Engine<T>::somebody_in_a_solid() {
  struct Seen {
    bool somebody = false;
    void merge(const Seen& other) { somebody |= other.somebody; }
  };
  return for_chunks<Seen>([&](const ParticleSpan& p, Seen& seen) {
           for (std::size_t s = p.begin; s < p.end; ++s) {
             seen.somebody |= p.id[s] >= 0.0 && domain.in_solid({p.x[s], p.y[s]}, time);
           }
         })
      .somebody;
}

/// Whether particles are to be removed, or their order has served its time.
template <typename T>
bool Engine<T>::order_due() {
  if (domain.in_solid && is_step_for(step_count, kSolidInterval, method.courant)) {
    leaving_ |= somebody_in_a_solid();
  }
  return leaving_ || is_step_for(step_count, kOrderLifetime, method.courant);
}

template <typename T>
void Engine<T>::advance_paths(double duration) {
  paths_.age += duration * method.sound_speed / method.smoothing_length;
}

template <typename T>
void Engine<T>::compare_with_paths(const ParticleSpan& p, Motion& seen) {
  sweeps_.updates.compare(p, pairs_, paths_.view(), kSkin<T>, static_cast<T>(paths_.age), seen);
}

/// New lists where the old ones no longer hold.
template <typename T>
void Engine<T>::keep_lists(const Motion& seen) {
  if (!seen.expired && paths_.age <= kSkin<double>.lifetime) return;
  const PassClock clock(seconds_of(Pass::sort));
  make_lists();
}

template <typename T>
void Engine<T>::sort() {
  const PassClock clock(seconds_of(Pass::sort));
  const bool fewer = leaving_ && remove();
  reorder(
      sort_into_clusters(team_, grid_, particles.position[0], particles.position[1], particles.id));
  particles.position_sorted = particles.position;
  bind();
  count_neighbours();
  ++sort_count;
  // From here on all is as a solver finds it that goes on with this state: the next step sees wall
  // pressures summed in this order, and nothing of what left.
  if (method.integrator == Integrator::kick_drift_kick) sum_wall_pressure();
  if (fewer) measure();
}

/// Takes out who is no particle of the fluid any more; whether there was any.
template <typename T>
bool Engine<T>::remove() {
  const std::size_t before = particle_count;
  for (std::size_t s = 0; s < particles.size(); ++s) {
    if (particles.id[s] < 0.0) continue;
    const auto cause = cause_to_remove(method, domain, particles, s, time);
    if (!cause) continue;
    removed.push_back(record_of(particles, s, *cause, step_count, time));
    particles.id[s] = kNobody;
    --particle_count;
  }
  return particle_count < before;
}

template <typename T>
void Engine<T>::reorder(Order order) {
  const Layout& next = order.layout;
  std::vector<double> moved;  // each field goes where the one before was
  for (const Field& field : kFields) {
    if (!carries(method.integrator, field)) continue;
    std::vector<double>& values = field.values.of(particles);
    const double empty = field.empty == EmptySlot::nobody ? kNobody : 0.0;
    const double scale = field.empty == EmptySlot::nowhere ? method.smoothing_length : 0.0;
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
  layout = std::move(order.layout);
}

/// Everything that follows from the order: origin cells, pair arrays and lists.
template <typename T>
void Engine<T>::bind() {
  const std::size_t slots = layout.slots();
  bounds.assign_origin_cells(team_, grid_, layout, particles.position_sorted[0].data(),
                             particles.position_sorted[1].data(), particles.id.data());
  scales_ = scales();
  pairs_.resize(slots);
  if (keeps_diffused(method)) pairs_.diffused.resize(slots);
  paths_.resize(slots);
  for_chunks([&](const ParticleSpan& p, Motion&) { write_pairs(p); });
  make_lists();
}

/// Pair lists for paths that begin here and now.
template <typename T>
void Engine<T>::make_lists() {
  paths_.age = 0.0;
  bounds.resize(layout);
  for_chunks([&](const ParticleSpan& p, Motion&) {
    paths_.begin(pairs_, p.begin, p.end);
    bounds.assign_boxes(p.begin / kCluster, p.end / kCluster, grid_, method.smoothing_length,
                        paths_.view());
  });
  bounds.assign_rows(team_, layout);
  const PairRange<T> range{static_cast<T>(method.support_ratio() + kListSlack),
                           constants_.origin_cell_size, grid_.has_one_origin_cell()};
  const PairSet<T> fluid{layout, bounds, paths_.view()};
  const PairSet<T> wall = walls_.set();
  const std::array lists{NewPairList<T>{&fluid, &fluid, &fluid_to_fluid_},
                         NewPairList<T>{&fluid, &wall, &fluid_to_wall_},
                         NewPairList<T>{&wall, &fluid, &wall_to_fluid_}};
  build_pair_lists(team_, sweeps_, range, std::span(lists).first(walls_.empty() ? 1 : 3));
  sums_.place(fluid_to_fluid_, layout.chunk,
              method.integrator == Integrator::modified_leap_frog ? kRateSums.stride
              : method.shifting                                   ? kDensityAndShiftingSums.stride
                                                                  : kAccelerationSums.stride);
}

template <typename T>
void Engine<T>::count_neighbours() {
  extremes.max_neighbours =
      most_neighbours(team_, layout, fluid_to_fluid_, sums_, pairs_, method.support_ratio());
}

template bool Engine<float>::order_due();
template bool Engine<double>::order_due();
template void Engine<float>::advance_paths(double);
template void Engine<double>::advance_paths(double);
template void Engine<float>::compare_with_paths(const ParticleSpan&, Motion&);
template void Engine<double>::compare_with_paths(const ParticleSpan&, Motion&);
template void Engine<float>::keep_lists(const Motion&);
template void Engine<double>::keep_lists(const Motion&);
template void Engine<float>::sort();
template void Engine<double>::sort();
template bool Engine<float>::remove();
template bool Engine<double>::remove();
template void Engine<float>::reorder(Order);
template void Engine<double>::reorder(Order);
template void Engine<float>::bind();
template void Engine<double>::bind();
template void Engine<float>::count_neighbours();
template void Engine<double>::count_neighbours();

}  // namespace sluice
