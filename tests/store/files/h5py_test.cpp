#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "engine/store/files/checkpoint_io.hpp"
#include "engine/store/files/series_file.hpp"
#include "engine/store/files/snapshot_io.hpp"
#include "tests/store/fixtures.hpp"

namespace sluice::test {
namespace {

namespace fs = std::filesystem;
// Debian's Python: h5py is installed for it.
const std::string kPython = "/usr/bin/python3";

TEST(H5py, ReadsOurFilesAndGetsTextsAsText) {
  if (std::system((kPython + " -c 'import h5py' 2>/dev/null").c_str()) != 0) {
    GTEST_SKIP() << "there is no " << kPython << " with h5py here";
  }
  const TemporaryFolder folder;
  const fs::path checkpoint = write_checkpoint(folder.path(), make_checkpoint(123));
  write_series(folder / "series.h5", make_samples());
  write_snapshot(folder / "frame.h5", make_test_snapshot(5));
  const fs::path here = fs::path(__FILE__).parent_path();
  const fs::path document = fs::path(SLUICE_SOURCE_DIR) / "schemas" / "checkpoint.md";
  const std::string command = kPython + " '" + (here / "read_with_h5py.py").string() + "' '" +
                              folder.path().string() + "' '" + document.string() + "'";
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
}

}  // namespace
}  // namespace sluice::test
