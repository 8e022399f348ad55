#include "record_folder.h"

#include <algorithm>
#include <array>
#include <ctime>
#include <fstream>
#include <optional>
#include <system_error>

#include "signal/number_text.h"
#include "telemetry/mcap/mcap_format.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view ending = ".mcap";
constexpr std::size_t date_length = sizeof "20261121_181500" - 1;

// "20261121_181500", in universal time.
std::string date_now() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  gmtime_r(&now, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y%m%d_%H%M%S", &parts);
  return text;
}

// The number in a name as next() makes them; nullopt for any other name.
std::optional<std::uint64_t> number_in(std::string_view name, std::string_view robot) {
  if (!name.starts_with(robot) || !name.ends_with(ending)) return std::nullopt;
  name.remove_prefix(robot.size());
  name.remove_suffix(ending.size());
  if (!name.starts_with("_")) return std::nullopt;
  name.remove_prefix(1);
  const std::size_t digits = std::min(name.find('_'), name.size());
  const auto number = number_of<std::uint64_t>(std::string(name.substr(0, digits)));
  if (!number || digits < 4) return std::nullopt;
  name.remove_prefix(digits);
  if (name.size() < 1 + date_length) return std::nullopt;
  const std::string_view date = name.substr(1, date_length), suffix = name.substr(1 + date_length);
  const bool dated = date.find_first_not_of("0123456789_") == std::string_view::npos && date[8] == '_';
  return dated && (suffix.empty() || suffix == "_flight") ? number : std::nullopt;
}

}  // namespace

bool is_record(const fs::path& file) {
  std::array<char, mcap_magic.size()> front{};
  std::ifstream(file, std::ios::binary).read(front.data(), front.size());
  return std::string_view(front.data(), front.size()) == mcap_magic;
}

std::vector<RecordFolder::Own> RecordFolder::own_records() const {
  std::vector<Own> all;
  std::error_code error;
  for (fs::directory_iterator i(folder_, error), end; !error && i != end; i.increment(error)) {
    const auto number = number_in(i->path().filename().string(), robot_);
    std::error_code none;
    if (!number || !fs::is_regular_file(i->symlink_status(none))) continue;
    const std::uint64_t bytes = i->file_size(none);
    all.push_back({*number, none ? 0 : bytes, i->path()});
  }
  std::ranges::sort(all, {}, &Own::number);
  return all;
}

fs::path RecordFolder::next(std::string_view suffix) const {
  const std::vector<Own> all = own_records();
  const auto number = static_cast<unsigned long long>(all.empty() ? 1 : all.back().number + 1);
  return folder_ / (robot_ + printed("_%04llu_", number) + date_now() + std::string(suffix) + std::string(ending));
}

std::size_t RecordFolder::make_room(std::uint64_t more_bytes, std::initializer_list<fs::path> kept) const {
  if (bytes_max_ == 0) return 0;
  const std::vector<Own> all = own_records();
  std::uint64_t bytes = more_bytes;
  for (const Own& record : all) bytes += record.bytes;
  std::size_t removed = 0;
  for (const Own& record : all) {
    if (bytes <= bytes_max_ || &record == &all.back()) break;
    std::error_code error;
    if (std::ranges::find(kept, record.file) != kept.end() || !fs::remove(record.file, error) || error) continue;
    bytes -= record.bytes;
    ++removed;
  }
  return removed;
}

}  // namespace kadans
