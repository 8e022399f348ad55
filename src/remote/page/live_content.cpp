
#include "live_content.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <utility>

#include <nlohmann/json.hpp>

#include "config/json/foreign_json.h"
#include "config/json/json_value.h"
#include "kadans/model/urdf.h"
#include "signal/byte_order.h"
#include "telemetry/record/recorder.h"

namespace kadans {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* drives_schema = R"({"title": "kadans.Drives", "type": "object"})";

std::vector<std::byte> copy_of(std::span<const std::byte> bytes) { return {bytes.begin(), bytes.end()}; }

}  // namespace

const LiveMessage* LiveChannel::next(std::uint64_t& seen) const noexcept {
  const std::uint64_t oldest = count - messages.size();
  if (seen >= count) return nullptr;
  seen = std::max(seen, oldest);
  return &messages[static_cast<std::size_t>(seen++ - oldest)];
}

void LiveChannel::put(std::uint64_t time_ns, std::span<const std::byte> payload) {
  if (!messages.empty() && (!events || messages.size() == events_kept)) messages.pop_front();
  messages.push_back({time_ns, copy_of(payload)});
  ++count;
}

LiveChannels::LiveChannels(const Instance& instance, const RobotTexts& texts)
    : topics_(signal_topics(instance.catalog().signals, Precision::full)),
      subjects_(instance.facts().subjects),
      viewers_(instance.catalog().signals, subjects_),
      description_(texts.description) {
  for (const SignalTopic& topic : topics_) {
    signals_["signals" + topic.topic] = topic.description;
    add({.topic = topic.topic,
         .encoding = "cdr",
         .schema_name = topic.type,
         .schema_encoding = "ros2msg",
         .schema = topic.definition});
  }
  first_viewer_ = channels_.size();
  for (const ViewerChannel& channel : viewers_.channels()) add(channel);
  log_ = add(log_channel, true);
  transitions_ = add(transitions_channel, true);
  active_ = add(active_channel, true);
  faults_ = add(faults_channel, true);
  timing_ = add(timing_channel);
  drives_ = add(json_channel("/drives", "kadans.Drives", drives_schema));
  described_ = add(description_channel);
  put_json(described_, 0, texts.description);
  write_robot_description(texts.urdf, message_);
  channels_[add(robot_description_channel(""))].put(0, message_.bytes());
  for (const RobotTexts::Other& other : texts.others) {
    write_robot_description(other.urdf, message_);
    channels_[add(robot_description_channel(other.name))].put(0, message_.bytes());
  }
}

std::size_t LiveChannels::add(ViewerChannel channel, bool events) {
  channels_.push_back({std::move(channel), events});
  return channels_.size() - 1;
}

void LiveChannels::put_json(std::size_t channel, std::int64_t time_ns, const std::string& json) {
  channels_[channel].put(static_cast<std::uint64_t>(time_ns), bytes_of(json));
}

void LiveChannels::take(const LatestRow::View& row) {
  if (row.values.empty()) return;
  for (std::size_t i = 0; i < topics_.size(); ++i) {
    payload_.resize(cdr_bytes(topics_[i].signals.size(), Precision::full));
    write_cdr(payload_, topics_[i], row.values, Precision::full);
    channels_[i].put(static_cast<std::uint64_t>(row.time_ns), payload_);
  }
  for (std::size_t i = 0; i < viewers_.channels().size(); ++i) {
    viewers_.write(i, row.time_ns, row.values, message_);
    channels_[first_viewer_ + i].put(static_cast<std::uint64_t>(row.time_ns), message_.bytes());
  }
}

void LiveChannels::take(const Event& event) {
  if (event.kind == Event::Kind::emitted) return;  // a line tells people of it
  const std::size_t channel = event.kind == Event::Kind::transition ? transitions_
                              : event.kind == Event::Kind::active   ? active_
                                                                    : log_;
  put_json(channel, event.transition.time_ns, json_of(event));
}

void LiveChannels::take(const Fault& fault, std::int64_t time_ns) {
  put_json(faults_, time_ns, json_of(told(fault, subjects_, time_ns)));
}

void LiveChannels::take_behaviors(const std::string& json) {
  Json description = parse_foreign_json(description_);
  description["behaviors"] = parse_foreign_json(json);
  description_ = json_text(description);
  put_json(described_, 0, description_);
}

void LiveChannels::take_drives(const std::string& json, std::int64_t time_ns) {
  if (std::exchange(drives_told_, json) != json) put_json(drives_, time_ns, json);
}

void LiveChannels::take_timing(const std::string& json, std::int64_t time_ns) { put_json(timing_, time_ns, json); }

namespace {

namespace fs = std::filesystem;
constexpr std::string_view package = "package://";
constexpr std::size_t file_max_bytes = std::size_t{16} << 20U;

// A robot may come from anybody: of what its URDF names only meshes and their pictures are handed out.
bool is_mesh(const fs::path& file) {
  constexpr std::array<std::string_view, 9> kinds{".stl",  ".dae", ".obj", ".ply", ".glb",
                                                  ".gltf", ".mtl", ".png", ".jpg"};
  std::string kind = file.extension().string();
  for (char& c : kind) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return std::ranges::find(kinds, kind) != kinds.end();
}

}  // namespace

LiveAssets::LiveAssets(const RobotTexts& texts, const std::string& urdf_file)
    : urdf_(std::make_shared<const std::string>(texts.urdf)),
      urdf_uri_(std::string(package) + texts.name + "/" + texts.name + ".urdf") {
  add_meshes(texts.urdf, urdf_file);
  for (const RobotTexts::Other& other : texts.others) add_meshes(other.urdf, other.file);
}

void LiveAssets::add_meshes(const std::string& urdf, const std::string& urdf_file) {
  constexpr std::string_view key = "filename=\"";
  for (std::size_t at = urdf.find(key); at != std::string::npos; at = urdf.find(key, at)) {
    at += key.size();
    const std::string name = urdf.substr(at, urdf.find('"', at) - at);
    files_.emplace(name, find_urdf_file(name, urdf_file).value_or(""));
  }
}

LiveAssets::Content LiveAssets::read(std::string_view uri) {
  if (uri == "robot.urdf" || uri == urdf_uri_) return urdf_;
  auto found = files_.find(uri);
  if (found == files_.end()) found = files_.find(std::string(package) + std::string(uri));
  if (found == files_.end() || !is_mesh(found->second)) return nullptr;
  std::weak_ptr<const std::string>& kept = read_[found->second];
  if (Content content = kept.lock()) return content;
  try {
    const auto content = std::make_shared<const std::string>(read_input_file(found->second, file_max_bytes));
    kept = content;
    return content;
  } catch (const InputError&) {
    return nullptr;
  }
}

}  // namespace kadans
