#include "tests/service/scheduler/scheduler_support.hpp"

#include <chrono>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <thread>

#include "engine/store/files/job_folder.hpp"

namespace sluice::test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::chrono::minutes kHang{10};
constexpr double kEndlessTime = 1e5;  // s of model time; a second of work for ten

Job add_job_with_scene(JobStore& store, const DataFolder& data, const std::string& scene, Job job) {
  job.id = store.new_id();
  (void)JobFolder::create(data.job(job.id), scene);
  return store.submit(job, "", "", 1'000'000).job;
}

}  // namespace

std::string tiny_scene(double end_time, double spacing) {
  Json scene = Json::parse(R"({
    "name": "tiny", "tank": {"width": 1.61, "height": 0.6}, "gravity": [0, -9.81],
    "fluid": [{"shape": "rectangle", "corner": [0, 0], "size": [0.6, 0.3]}],
    "numerics": {"scheme": "paper", "reinitialisation": null,
                 "integrator": "kick_drift_kick", "courant": 0.5,
                 "density_diffusion": {"delta": 0.1}, "artificial_viscosity": {"alpha": 0.02}},
    "sensors": [{"name": "P1", "kind": "pressure", "position": [1.61, 0.02], "interval": 0.001}]
  })");
  scene["resolution"] = {{"spacing", spacing}};
  scene["end_time"] = end_time;
  return scene.dump();
}

std::string endless_scene() {
  Json scene = Json::parse(R"({
    "name": "still", "tank": {"width": 0.6, "height": 0.6}, "gravity": [0, -9.81],
    "fluid": [{"shape": "rectangle", "corner": [0, 0], "size": [0.6, 0.3]}],
    "resolution": {"spacing": 0.03},
    "numerics": {"scheme": "paper", "reinitialisation": null,
                 "integrator": "kick_drift_kick", "courant": 0.25,
                 "density_diffusion": {"kind": "fourtakas", "delta": 0.1},
                 "artificial_viscosity": {"alpha": 0.1}}
  })");
  scene["end_time"] = kEndlessTime;
  return scene.dump();
}

fs::path write_worker(const DataFolder& data, std::string_view script) {
  const fs::path path = data.path() / "worker.sh";
  std::string text = "#!/bin/bash\nn=$(($(cat \"$2/n\" 2>/dev/null) + 1))\necho $n > \"$2/n\"\n";
  text += script;
  text += '\n';
  write_file(path, text);
  fs::permissions(path, fs::perms::owner_all);
  return path;
}

Job add_real_job(JobStore& store, const DataFolder& data, double end_time, int priority,
                 int threads) {
  Job job = a_job(priority, threads);
  job.end_time = end_time;
  return add_job_with_scene(store, data, tiny_scene(end_time), job);
}

Job add_slow_job(JobStore& store, const DataFolder& data) {
  Job job = a_job();
  job.end_time = 6.0;
  return add_job_with_scene(store, data, tiny_scene(job.end_time, 0.03), job);
}

Job add_endless_job(JobStore& store, const DataFolder& data) {
  Job job = a_job();
  job.end_time = kEndlessTime;
  return add_job_with_scene(store, data, endless_scene(), job);
}

ServiceLimits limits_for_scripts() {
  ServiceLimits limits = limits_for_sluice();
  limits.confinement = Confinement::none;
  return limits;
}

ServiceLimits limits_for_sluice() {
  ServiceLimits limits;
  limits.cores = 2;
  limits.disk_reserve = 0;
  return limits;
}

fs::path sluice_program() { return SLUICE_PROGRAM; }

void wait_until(std::string_view what, const std::function<bool()>& condition) {
  const auto end = std::chrono::steady_clock::now() + kHang;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) {
      throw std::runtime_error("waited in vain for " + std::string(what));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

Job wait_for(const JobStore& store, const std::string& id, JobState state) {
  wait_until(std::string(to_string(state)) + ", history: " + history(store, id), [&] {
    const Job job = store.find(id).value();
    if (is_ended(job.state) && job.state != state) {
      throw std::runtime_error("the job is " + std::string(to_string(job.state)) + ": " +
                               job.reason + ", history: " + history(store, id));
    }
    return job.state == state;
  });
  return store.find(id).value();
}

std::string wait_for_event(const JobStore& store, const std::string& id, std::string_view name) {
  wait_until(name, [&] { return count_events(store, id, name) > 0; });
  for (const JobEvent& event : store.events(id, 0, 10000)) {
    if (event.name == name) return event.detail;
  }
  return {};
}

int count_events(const JobStore& store, const std::string& id, std::string_view name) {
  int count = 0;
  for (const JobEvent& event : store.events(id, 0, 10000)) count += event.name == name ? 1 : 0;
  return count;
}

int worker_pid(const JobStore& store, const std::string& id) {
  int pid = 0;
  for (const JobEvent& event : store.events(id, 0, 10000)) {
    if (event.name == "worker_started") pid = Json::parse(event.detail).at("pid").get<int>();
  }
  return pid;
}

std::string physics_digest_of(const Job& job) {
  return Json::parse(job.outcome).at("digests").at("physics").get<std::string>();
}

std::string read_file(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

void write_file(const fs::path& path, std::string_view text) {
  std::ofstream stream(path, std::ios::binary);
  stream << text;
  if (!stream.flush()) throw std::runtime_error("cannot write " + path.string());
}

}  // namespace sluice::test
