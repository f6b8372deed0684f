#pragma once

#include <gtest/gtest.h>

#include <string>

#include "engine/store/disk/errors.hpp"

namespace sluice::test {

/// Runs `action`, expects a StorageError of that fault and returns its message.
template <class Action>
std::string expect_fault(StorageFault fault, const Action& action) {
  try {
    action();
  } catch (const StorageError& error) {
    EXPECT_EQ(to_string(error.fault()), to_string(fault)) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "no error where " << to_string(fault) << " is expected";
  return {};
}

}  // namespace sluice::test
