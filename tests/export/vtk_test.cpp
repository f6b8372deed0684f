#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "engine/export/vtk_file.hpp"
#include "tests/store/fixtures.hpp"

namespace sluice::test {
namespace {

namespace fs = std::filesystem;

TEST(VtkFile, HasTheLayoutThatParaViewReads) {
  const std::string python = "/usr/bin/python3";
  if (std::system((python + " -c 'import h5py' 2>/dev/null").c_str()) != 0) {
    GTEST_SKIP() << "there is no " << python << " with h5py here";
  }
  const TemporaryFolder folder;
  Snapshot frame = make_test_snapshot(100000);
  frame.origin.x() = 1e5;
  write_vtk(folder / vtk_name("frames/frame-000012.h5"), frame);
  write_vtk(folder / "empty.hdf", empty_snapshot(0, 0.0, 2));
  const fs::path script = fs::path(__FILE__).parent_path() / "check_vtk.py";
  const std::string command =
      python + " '" + script.string() + "' '" + folder.path().string() + "'";
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
}

TEST(VtkFile, SeriesNamesTheFilesBesideItWithTheirTimes) {
  EXPECT_EQ(vtk_series_text({{"frame-000000.hdf", 0.0}, {"frame-000001.hdf", 0.125}}),
            "{\n \"file-series-version\": \"1.0\",\n \"files\": [\n  {\n   \"name\": "
            "\"frame-000000.hdf\",\n   \"time\": 0.0\n  },\n  {\n   \"name\": "
            "\"frame-000001.hdf\",\n   \"time\": 0.125\n  }\n ]\n}\n");
}

}  // namespace
}  // namespace sluice::test
