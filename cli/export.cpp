#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <memory>
#include <string_view>
#include <vector>

#include "cli/job_data.hpp"
#include "cli/verbs.hpp"
#include "engine/ladder/markup.hpp"
#include "engine/store/apart.hpp"
#include "engine/store/errors.hpp"
#include "engine/store/frame_io.hpp"
#include "engine/store/publish.hpp"

namespace sluice {
namespace {

namespace fs = std::filesystem;

enum class ExportFormat { xdmf, csv };

struct ExportArguments {
  std::string folder;
  std::string output;
  ExportFormat format = ExportFormat::xdmf;
};

struct Item {
  std::string_view name;
  std::string_view type;
};
constexpr std::array kAttributes{Item{"vx", R"(NumberType="Float" Precision="4")"},
                                 Item{"vy", R"(NumberType="Float" Precision="4")"},
                                 Item{"pressure", R"(NumberType="Float" Precision="4")"},
                                 Item{"id", R"(NumberType="UInt" Precision="8")"}};

std::string data_item(std::string_view file, const Item& item, std::size_t count) {
  return fmt::format(R"(<DataItem Format="HDF" {} Dimensions="{}">{}:/particles/{}</DataItem>)",
                     item.type, count, file, item.name);
}

/// One moment: points with their values, read by ParaView straight from the frame's HDF5.
std::string xdmf_grid(const std::string& file, const Frame& frame) {
  const std::size_t count = frame.x.size();
  constexpr std::string_view kFloat = R"(NumberType="Float" Precision="4")";
  std::string text = fmt::format(
      "  <Grid Name=\"step {}\">\n   <Time Value=\"{}\"/>\n"
      "   <Topology TopologyType=\"Polyvertex\" NumberOfElements=\"{}\"/>\n"
      "   <Geometry GeometryType=\"X_Y\">\n    {}\n    {}\n   </Geometry>\n",
      frame.step, frame.time, count, data_item(file, {"x", kFloat}, count),
      data_item(file, {"y", kFloat}, count));
  for (const Item& item : kAttributes) {
    text += fmt::format("   <Attribute Name=\"{}\" Center=\"Node\">\n    {}\n   </Attribute>\n",
                        item.name, data_item(file, item, count));
  }
  return text + "  </Grid>\n";
}

Frame read_harmless_frame(const fs::path& path) {
  return read_harmless(path, [&] { return read_frame(path); });
}

void export_xdmf(const std::vector<fs::path>& frames, const fs::path& output) {
  std::string text =
      "<?xml version=\"1.0\"?>\n<Xdmf Version=\"2.0\">\n <Domain>\n"
      "  <Grid Name=\"frames\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
  for (const fs::path& path : frames) {
    const fs::path reference = fs::absolute(path).lexically_relative(fs::absolute(output));
    text += xdmf_grid(escaped(reference.string()), read_harmless_frame(path));
  }
  text += "  </Grid>\n </Domain>\n</Xdmf>\n";
  const fs::path target = output / "frames.xdmf";
  publish_text(target, text);
  fmt::print("{}: {} frames; open it with ParaView's Xdmf Reader\n", target.string(),
             frames.size());
}

void export_csv(const std::vector<fs::path>& frames, const fs::path& output) {
  for (const fs::path& path : frames) {
    const Frame frame = read_harmless_frame(path);
    std::string text = "time_s,id,x_m,y_m,vx_m_s,vy_m_s,pressure_Pa\n";
    for (std::size_t i = 0; i < frame.x.size(); ++i) {
      text += fmt::format("{},{},{},{},{},{},{}\n", frame.time, frame.id[i], frame.x[i], frame.y[i],
                          frame.vx[i], frame.vy[i], frame.pressure[i]);
    }
    publish_text(output / path.filename().replace_extension(".csv"), text);
  }
  fmt::print("{}: {} files\n", output.string(), frames.size());
}

void export_frames(const ExportArguments& arguments) {
  const JobData job(arguments.folder);
  const std::vector<fs::path> frames = job.paths().frame_files();
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
  (arguments.format == ExportFormat::xdmf ? export_xdmf : export_csv)(frames, output);
}

}  // namespace

void add_export(CLI::App& app) {
  auto arguments = std::make_shared<ExportArguments>();
  CLI::App* verb = app.add_subcommand("export", "Make a job's frames readable for other programs");
  verb->add_option("folder", arguments->folder, "The job's folder")
      ->required()
      ->check(CLI::ExistingDirectory);
  const std::map<std::string, ExportFormat> formats{{"xdmf", ExportFormat::xdmf},
                                                    {"csv", ExportFormat::csv}};
  verb->add_option("--format", arguments->format,
                   "xdmf: one file for ParaView beside the frames; csv: a table per frame")
      ->required()
      ->transform(CLI::CheckedTransformer(formats).description("{xdmf,csv}"));
  verb->add_option("--output", arguments->output, "Where to; by default the job's frames folder");
  verb->footer("Example: sluice export dambreak-quick --format xdmf");
  verb->callback([arguments] { export_frames(*arguments); });
}

}  // namespace sluice
