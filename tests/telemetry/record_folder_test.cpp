// The folder of a robot's records: names, order and bound.
#include "telemetry/record/record_folder.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include <doctest/doctest.h>
#include <unistd.h>

namespace record_folder_test {

using namespace kadans;
namespace fs = std::filesystem;

namespace {

class Folder {
 public:
  explicit Folder(const std::string& name)
      : path_(fs::path(KADANS_BINARY_DIR) / "tests" / (name + "." + std::to_string(getpid()))) {
    fs::remove_all(path_);
    fs::create_directories(path_);
  }
  ~Folder() { fs::remove_all(path_); }

  const fs::path& path() const { return path_; }
  fs::path put(const std::string& name, std::size_t bytes) const {
    std::ofstream(path_ / name) << std::string(bytes, 'x');
    return path_ / name;
  }
  std::set<std::string> names() const {
    std::set<std::string> names;
    for (const fs::directory_entry& entry : fs::directory_iterator(path_)) names.insert(entry.path().filename());
    return names;
  }

 private:
  fs::path path_;
};

}  // namespace

TEST_CASE("A record that nobody named gets the number after the highest one, whatever the clock says") {
  const Folder folder("record_names");
  const RecordFolder records(folder.path(), "tulip");
  CHECK(records.next("").filename().string().starts_with("tulip_0001_"));
  folder.put("tulip_0041_20991231_235959.mcap", 1);
  folder.put("tulip_0009_20260101_000000_flight.mcap", 1);
  folder.put("tulip_0050_notes.mcap", 1);
  folder.put("tulip_0060_20260101_000000.mcap.old", 1);
  folder.put("tulip_left_0070_20260101_000000.mcap", 1);
  const std::string next = records.next("_flight").filename();
  CHECK(next.starts_with("tulip_0042_"));
  CHECK(next.ends_with("_flight.mcap"));
  CHECK(next.size() == std::string("tulip_0042_20991231_235959_flight.mcap").size());
}

TEST_CASE("The oldest records go until the rest fits, and nothing else goes") {
  const Folder folder("record_bound");
  const fs::path first = folder.put("tulip_0001_20300101_000000.mcap", 100);  // by the clock it is the newest
  folder.put("tulip_0002_20260101_000000_flight.mcap", 100);
  folder.put("tulip_0003_20260101_000000.mcap", 100);
  const fs::path open = folder.put("tulip_0004_20260101_000000.mcap", 100);
  folder.put("other_0001_20260101_000000.mcap", 1000);
  folder.put("walk.mcap", 1000);
  fs::create_symlink(folder.path() / "walk.mcap", folder.path() / "tulip_0000_20260101_000000.mcap");

  CHECK(RecordFolder(folder.path(), "tulip", 0).make_room(1000, {}) == 0);
  const RecordFolder records(folder.path(), "tulip", 400);
  CHECK(records.make_room(0, {open}) == 0);
  CHECK(records.make_room(150, {open}) == 2);
  CHECK(folder.names() == std::set<std::string>{"tulip_0003_20260101_000000.mcap", "tulip_0004_20260101_000000.mcap",
                                                "other_0001_20260101_000000.mcap", "walk.mcap",
                                                "tulip_0000_20260101_000000.mcap"});
  CHECK(records.make_room(400, {open}) == 1);  // the open one stays, even when nothing fits
  CHECK(fs::exists(open));
  CHECK_FALSE(fs::exists(first));
  CHECK(records.make_room(400, {}) == 0);  // the next number follows from it
  CHECK(records.next("").filename().string().starts_with("tulip_0005_"));
}

}  // namespace record_folder_test
