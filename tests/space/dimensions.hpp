#pragma once

#include <gtest/gtest.h>

#include <type_traits>

namespace sluice::testing {

/// The dimensions that a typed test of a template over `Dim` goes through; the type's value is Dim.
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;

}  // namespace sluice::testing
