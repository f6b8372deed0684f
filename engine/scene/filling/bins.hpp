#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/space/lattice.hpp"

namespace sluice {

/// Points in cells of equal sides, row by row, so that those near a place are found.
template <int Dim>
class Bins {
 public:
  /// `size` of a cell; it grows where cells would be many more than points.
  Bins(std::span<const VecN<Dim>> points, double size) : size_(size) {
    if (points.empty()) return;
    BoxN<Dim> box{points.front(), points.front()};
    for (const VecN<Dim>& point : points) box.take_in(point);
    low_ = box.min;
    // A long thin body at an angle: cells grow rather than their number.
    const double most = 4.0 * static_cast<double>(points.size()) + 1024.0;
    while ((box.size() / size_ + VecN<Dim>::Ones()).prod() > most) size_ *= 1.25;
    last_ = cell(box.max);
    begin_.assign(index(last_) + 2, 0);
    for (const VecN<Dim>& point : points) ++begin_[index(cell(point)) + 1];
    for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
    members_.resize(points.size());
    std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
    for (std::size_t i = 0; i < points.size(); ++i) {
      members_[next[index(cell(points[i]))]++] = static_cast<std::uint32_t>(i);
    }
  }

  /// Calls f(index) for all points in the cell of a place and those around it.
  template <class F>
  void near(const VecN<Dim>& place, const F& f) const {
    if (members_.empty()) return;
    CellN<Dim> first = shifted<Dim>(cell(place), -1), last = shifted<Dim>(first, 2);
    for (int axis = 0; axis < Dim; ++axis) {
      first[axis] = std::max<std::int64_t>(first[axis], 0);
      last[axis] = std::min(last[axis], last_[axis]);
    }
    for_each_row<Dim>(first, last, [&](CellN<Dim> row) {
      const std::uint32_t from = begin_[index(row)];
      row[0] = last[0];
      const std::uint32_t to = begin_[index(row) + 1];
      for (std::uint32_t i = from; i < to; ++i) f(members_[i]);
    });
  }

 private:
  [[nodiscard]] CellN<Dim> cell(const VecN<Dim>& place) const {
    return cell_at<Dim>((place - low_) / size_);
  }
  /// Of a cell among all, row by row.
  [[nodiscard]] std::size_t index(const CellN<Dim>& cell) const {
    return index_between<Dim>({}, last_, cell);
  }

  double size_;
  VecN<Dim> low_ = VecN<Dim>::Zero();
  CellN<Dim> last_{};
  std::vector<std::uint32_t> begin_;  ///< of each cell's members, and an end
  std::vector<std::uint32_t> members_;
};

}  // namespace sluice
