// The folder in which a robot's records are kept, their names, and how much room they may take.
//
// A record that nobody named is called ROBOT_NUMBER_DATE.mcap, such as "tulip_0042_20261121_181500.mcap", in universal
// time. A robot's clock may be wrong, so the number tells which is newer. With a bound, the oldest of these records go
// when a new one needs the room. Files with other names are never touched.
//
// One thread at a time. Nothing here throws: a disk that fails is told by the record that cannot be written.
#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace kadans {

// Whether the file begins as records do, whatever it is called.
bool is_record(const std::filesystem::path& file);

class RecordFolder {
 public:
  // `bytes_max`: of all records of this robot that nobody named; 0: there is no bound.
  RecordFolder(std::filesystem::path folder, std::string robot, std::uint64_t bytes_max = 0)
      : folder_(std::move(folder)), robot_(std::move(robot)), bytes_max_(bytes_max) {}

  const std::filesystem::path& folder() const noexcept { return folder_; }
  // A file that is not there yet, with the number after the highest one. `suffix`: "" or "_flight".
  std::filesystem::path next(std::string_view suffix) const;
  // Removes the oldest records until those that are left, and `more_bytes`, fit in. Files in `kept` stay, and count; so
  // does the newest record, from whose number the next one follows.
  // Returns how many were removed.
  std::size_t make_room(std::uint64_t more_bytes, std::initializer_list<std::filesystem::path> kept) const;

 private:
  struct Own {
    std::uint64_t number = 0, bytes = 0;
    std::filesystem::path file;
  };
  std::vector<Own> own_records() const;  // the oldest first

  std::filesystem::path folder_;
  std::string robot_;
  std::uint64_t bytes_max_;
};

}  // namespace kadans
