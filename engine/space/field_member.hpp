#pragma once

#include "engine/space/axes.hpp"

namespace sluice {

/// The axis of what has no direction.
inline constexpr int kNoAxis = -1;

/// A member of Owner, or one axis of a member that has a Value for each. Tables of fields hold it,
/// so that who walks them need not know how many axes there are.
template <class Owner, class Value, class Axes = PerAxis<Value>>
class FieldMember {
 public:
  constexpr FieldMember(Value Owner::*scalar)  // NOLINT(google-explicit-constructor)
      : scalar_(scalar) {}
  constexpr FieldMember(Axes Owner::*vector, int axis) : vector_(vector), axis_(axis) {}

  [[nodiscard]] constexpr int axis() const { return axis_; }
  [[nodiscard]] Value& of(Owner& owner) const {
    return axis_ == kNoAxis ? owner.*scalar_ : (owner.*vector_)[static_cast<Index>(axis_)];
  }
  [[nodiscard]] const Value& of(const Owner& owner) const {
    return axis_ == kNoAxis ? owner.*scalar_ : (owner.*vector_)[static_cast<Index>(axis_)];
  }

 private:
  using Index = decltype(Axes{}.size());

  Value Owner::*scalar_ = nullptr;
  Axes Owner::*vector_ = nullptr;
  int axis_ = kNoAxis;
};

}  // namespace sluice
