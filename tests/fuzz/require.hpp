#pragma once

#include <cstdio>
#include <cstdlib>

namespace sluice::fuzz {

/// Ends the fuzzer's run as a finding when what must hold of any input does not.
inline void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n", what);
  std::abort();
}

}  // namespace sluice::fuzz
