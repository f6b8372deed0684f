#include "service/jobs/repair.hpp"

#include <filesystem>
#include <string>

#include "service/jobs/retention.hpp"
#include "tests/service/api/api_support.hpp"

namespace sluice::test {
namespace {

namespace fs = std::filesystem;

/// What the next start makes of a service that was killed in between.
void repair(Service& service) { repair_folders(service.store, service.data.path()); }

TEST(Repair, GivesASceneTheEndThatItsRowKnows) {
  Service service;
  const std::string id = service.submit_in(JobState::completed);
  const fs::path scene = service.data.job(id) / "scene.json";
  write_file(scene, with_end_time(read_file(scene), 5.0));
  repair(service);
  expect_agreement(service);
}

TEST(Repair, UndoesADeletionWhoseRowIsThereAndEndsOneWhoseRowIsGone) {
  Service service;
  const std::string kept = service.submit_in(JobState::completed);
  const std::string gone = service.submit_in(JobState::completed);
  for (const std::string& id : {kept, gone}) {
    fs::rename(service.data.job(id), deleted_folder(service.data.path(), id));
  }
  service.store.remove(gone);
  EXPECT_EQ(service.get("/v1/jobs/" + kept + "/sensors").status, 404);
  repair(service);
  expect_agreement(service);
  EXPECT_EQ(service.get("/v1/jobs/" + kept + "/sensors").status, 200);
  EXPECT_TRUE(cut_deletions(service.data.path()).empty());
}

TEST(Repair, RemovesTemporariesOfOursAndNothingElse) {
  Service service;
  const std::string id = service.submit_in(JobState::completed);
  for (const char* const name : {".scene.json.4711.0.tmp", ".job.json.4711.3.tmp",
                                 ".report.json.4711.12.tmp", "mine.tmp", ".mine.tmp"}) {
    write_file(service.data.job(id) / name, "x");
  }
  repair(service);
  std::size_t left = 0;
  for (const auto& entry : fs::directory_iterator(service.data.job(id))) {
    left += entry.path().extension() == ".tmp" ? 1 : 0;
  }
  EXPECT_EQ(left, 2u);
}

TEST(Repair, ReportsAFolderThatItCannotMend) {
  Service service;
  const std::string id = service.submit_in(JobState::completed);
  write_file(service.data.job(id) / "scene.json", "rubbish");
  std::string told;
  repair_folders(service.store, service.data.path(),
                 [&](const fs::path& folder, const std::string&) { told = folder.filename(); });
  EXPECT_EQ(told, id);
}

}  // namespace
}  // namespace sluice::test
