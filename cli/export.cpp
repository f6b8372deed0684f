#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "cli/checks.hpp"
#include "cli/job_data.hpp"
#include "cli/verbs.hpp"
#include "engine/export/vtk_file.hpp"
#include "engine/store/disk/apart.hpp"
#include "engine/store/disk/errors.hpp"
#include "engine/store/disk/publish.hpp"
#include "engine/store/files/snapshot_io.hpp"

namespace sluice {
namespace {

namespace fs = std::filesystem;

enum class ExportFormat { vtkhdf, csv };

struct ExportArguments {
  std::string folder;
  std::string output;
  ExportFormat format = ExportFormat::vtkhdf;
};

Snapshot read_harmless_snapshot(const fs::path& path) {
  return read_harmless(path, [&] { return read_snapshot(path); });
}

/// A file for each frame, and one that gives ParaView their times. Files are named beside each
/// other, so that no character of a folder's name matters and the folder can be moved.
void export_vtk(const std::vector<fs::path>& frames, const fs::path& output) {
  std::vector<std::pair<std::string, double>> files;
  for (const fs::path& path : frames) {
    const Snapshot frame = read_harmless_snapshot(path);
    files.emplace_back(vtk_name(path), frame.time);
    write_vtk(output / files.back().first, frame);
  }
  const fs::path target = output / "frames.hdf.series";
  publish_text(target, vtk_series_text(files));
  fmt::print("{}: {} frames; open it with ParaView\n", target.string(), frames.size());
}

/// A unit in a column's name: m/s becomes m_s.
std::string unit_word(std::string_view unit) {
  std::string word(unit);
  std::replace(word.begin(), word.end(), '/', '_');
  return word;
}

std::string csv_text(const Snapshot& frame) {
  std::string text = "time_s,id";
  const auto fields = snapshot_fields_in(frame.position.size());
  for (const SnapshotField& field : fields) {
    text += fmt::format(",{}_{}", field.name, unit_word(field.unit));
  }
  text += '\n';
  for (std::size_t i = 0; i < frame.size(); ++i) {
    const Vec place = frame.position_of(i);
    text += fmt::format("{},{}", frame.time, frame.id[i]);
    for (const SnapshotField& field : fields) {
      // Positions in the file are relative to its origin.
      if (field.unit == "m") {
        text += fmt::format(",{}", place[field.values.axis()]);
      } else {
        text += fmt::format(",{}", field.values.of(frame)[i]);
      }
    }
    text += '\n';
  }
  return text;
}

void export_csv(const std::vector<fs::path>& frames, const fs::path& output) {
  for (const fs::path& path : frames) {
    const Snapshot frame = read_harmless_snapshot(path);
    publish_text(output / path.filename().replace_extension(".csv"), csv_text(frame));
  }
  fmt::print("{}: {} files\n", output.string(), frames.size());
}

void export_snapshots(const ExportArguments& arguments) {
  const JobReader job = job_or_end(arguments.folder);
  const std::vector<fs::path> frames = job.paths().snapshot_files();
  if (frames.empty()) {
    throw CommandEnd(ExitCode::usage,
                     fmt::format("{} has no frames: its scene has no key output.frames, or it did "
                                 "not run yet",
                                 arguments.folder));
  }
  const fs::path output =
      arguments.output.empty() ? job.paths().frames() : fs::path(arguments.output);
  std::error_code error;
  fs::create_directories(output, error);
  if (error) {
    throw CommandEnd(ExitCode::storage_failure,
                     fmt::format("cannot make {}: {}", output.string(), error.message()));
  }
  (arguments.format == ExportFormat::vtkhdf ? export_vtk : export_csv)(frames, output);
}

}  // namespace

void add_export(CLI::App& app) {
  auto arguments = std::make_shared<ExportArguments>();
  CLI::App* verb = app.add_subcommand("export", "Make a job's frames readable for other programs");
  verb->add_option("folder", arguments->folder, "The job's folder")
      ->required()
      ->check(existing_folder());
  const std::map<std::string, ExportFormat> formats{{"vtkhdf", ExportFormat::vtkhdf},
                                                    {"csv", ExportFormat::csv}};
  verb->add_option("--format", arguments->format,
                   "vtkhdf (default): frames.hdf.series and a file per frame for ParaView; csv: a "
                   "table per frame")
      ->transform(one_of(formats));
  verb->add_option("--output", arguments->output, "Where to; by default the job's frames folder");
  verb->footer("Example: sluice export dambreak-quick");
  verb->callback([arguments] { export_snapshots(*arguments); });
}

}  // namespace sluice
