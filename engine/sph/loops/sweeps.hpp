#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <tuple>

#include "engine/sph/loops/updates.hpp"
#include "engine/sph/method/method.hpp"
#include "engine/sph/pairs/pair_arrays.hpp"
#include "engine/sph/pairs/pair_list.hpp"

namespace sluice {

/// Constants of the terms of the rates against one kind of neighbours, dimensionless. Those of an
/// absent term are not read.
template <typename T, class... Listed>
std::tuple<typename Listed::template Constants<T>...> constants_of(TermList<Listed...>);
template <typename T>
using RateConstants = decltype(constants_of<T>(RateTerms{}));

/// Constants of all sums, dimensionless.
template <typename T, int Dim>
struct TermConstants {
  RateConstants<T> in_fluid, at_walls;
  std::array<T, Dim> gravity{};      ///< f h/c^2
  OriginShift<T, Dim> origin_shift;  ///< in h
};

/// One chunk of clusters i against the clusters j of its lists.
template <typename T, int Dim>
struct SweepTask {
  PairView<T, Dim> self;                      ///< the set of i
  PairView<T, Dim> fluid;                     ///< j of `to_fluid`
  PairView<T, Dim> wall;                      ///< j of `to_wall`
  const PairList::Chunk* to_fluid = nullptr;  ///< mutual, but not for the wall pressure
  const PairList::Chunk* to_wall = nullptr;   ///< null without walls
  std::size_t first_cluster = 0;
  std::size_t clusters = 0;
  const TermConstants<T, Dim>* constants = nullptr;
  T* sums = nullptr;  ///< out: per place of `to_fluid`, before their common scale (SumBlocks); for
                      ///< the wall pressure one value per slot
};

/// A cluster i, by its box, whose possible neighbours among the clusters j are wanted.
template <int Dim>
struct SearchTask {
  /// Clusters j of a row; those before `next` are near neither i nor a later cluster of its
  /// row.
  struct Row {
    std::uint32_t next = 0;
    std::uint32_t end = 0;
  };
  BoxesView<Dim> boxes;                  ///< of the clusters j
  std::array<float, Dim> low{}, high{};  ///< of cluster i, h
  float range{};                         ///< the cut-off, h
  float left_after{};                    ///< least low[0] from cluster i on, less the cut-off
  std::uint32_t first = 0;               ///< clusters j before it are left out
  std::span<Row> rows;                   ///< of the rows near i; `next` is moved on
  std::uint32_t* out = nullptr;          ///< entries; room for all clusters of the rows and kTail
};

/// A cluster i whose list of possible neighbours among the clusters j is wanted.
template <typename T, int Dim>
struct PruneTask {
  ListPathsView<T, Dim> self, other;
  T cut_off{};  ///< support in h
  const OriginShift<T, Dim>* shift = nullptr;
  std::size_t cluster = 0;
  const std::uint32_t* candidates = nullptr;  ///< entries to test, in order
  std::size_t count = 0;
  std::uint32_t* out = nullptr;  ///< room for `count` entries
};

/// The loops over pairs for the terms of one method on one SIMD target, chosen once per run.
template <typename T, int Dim>
struct Sweeps {
  using Sweep = void (*)(const SweepTask<T, Dim>&);

  Sweep density_and_acceleration = nullptr;  ///< eqs. 4, 5, 7, 8 in one sweep
  Sweep density = nullptr;                   ///< eqs. 4, 7
  Sweep density_and_shift = nullptr;         ///< eqs. 4, 7, and the sums of particle shifting
  Sweep acceleration = nullptr;              ///< eqs. 5, 8, viscous stress
  Sweep wall_pressure = nullptr;             ///< eq. 9: sums = s of the wall particle
  Sweep reinitialise = nullptr;              ///< eq. 10
  /// The clusters whose boxes meet that of cluster i, as entries of the same origin cell; returns
  /// how many.
  std::size_t (*search)(const SearchTask<Dim>&) = nullptr;
  /// Keeps the candidates of which a particle may come within the cut-off of one of cluster i while
  /// both stay within the skin of their paths.
  std::size_t (*prune)(const PruneTask<T, Dim>&) = nullptr;
  Updates<T, Dim> updates;  ///< the loops over particles that go with them
  std::string_view target;  ///< name of the SIMD target
};

/// Throws std::invalid_argument when `target` is neither empty nor one that this machine runs,
/// naming those it does.
template <typename T, int Dim>
[[nodiscard]] Sweeps<T, Dim> select_sweeps(const MethodN<Dim>& method, const std::string& target);

template <>
Sweeps<float, 2> select_sweeps<float, 2>(const MethodN<2>&, const std::string&);
template <>
Sweeps<double, 2> select_sweeps<double, 2>(const MethodN<2>&, const std::string&);
template <>
Sweeps<float, 3> select_sweeps<float, 3>(const MethodN<3>&, const std::string&);
template <>
Sweeps<double, 3> select_sweeps<double, 3>(const MethodN<3>&, const std::string&);

}  // namespace sluice
