#include "supervisor_config.h"

#include <algorithm>

#include "kadans/signal/capacity.h"
#include "kadans/signal/nearest_name.h"

namespace kadans {
namespace {

constexpr double far_m = 1000, any = 1e9, forget_max_s = 1e6;
constexpr std::size_t name_max = 32;
constexpr const char* name_rule = "small letters, digits and '_', a letter first, at most 32 characters";

bool is_name(const std::string& name) {
  const auto fits = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; };
  return !name.empty() && name.size() <= name_max && name[0] >= 'a' && name[0] <= 'z' &&
         std::ranges::all_of(name, fits);
}

void check_name(const Fields& f, const char* what) {
  if (!f.reading() || is_name(f.key())) return;
  f.refuse(f.key_place(), std::string(what) + " is named with " + name_rule + ", not " + in_quotes(f.key()));
}

void seen_field(Fields& f, SeenInfo& entry) {
  SeenField field{.name = f.key(), .min = -any, .max = any};
  check_name(f, "a field");
  f.string("unit", field.unit, "its unit");
  f.string("what", field.doc, "what it is, a sentence without a full stop");
  f.number("min", field.min, {-any, any}, "an observation below it is refused");
  f.number("max", field.max, {-any, any}, "an observation above it is refused");
  if (!f.reading()) return;
  if (!(field.min <= field.max)) f.refuse(f.key_place(), f.path() + ": min is not above max");
  for (const char* own : {"age_s", "confidence", "carried", "source", "doc"}) {
    if (field.name == own) f.refuse(f.key_place(), f.path() + ": every entry has '" + field.name + "' of its own");
  }
  if (std::ranges::find(entry.fields, field.name, &SeenField::name) != entry.fields.end())
    f.refuse(f.key_place(), f.path() + ": a place has '" + field.name + "' already");
  if (field.doc.empty()) field.doc = field.name;
  entry.fields.push_back(std::move(field));
}

const std::string place_names[] = {"none", "point", "pose"};
enum class PlaceKind : std::uint8_t { none, point, pose };

void seen_entry(Fields& f, std::vector<SeenInfo>& all) {
  SeenInfo entry{.name = f.key(), .doc = f.key()};
  PlaceKind place = PlaceKind::none;
  double within_m = 100;
  check_name(f, "an entry");
  f.string("what", entry.doc, "what it is, a sentence without a full stop");
  const bool placed = f.choice(
      "place", place, place_names,
      "where it is, as the robot sees it: a point has x_m and y_m, a pose has heading_rad, too; both are carried on "
      "by the odometry");
  f.number("within_m", within_m, {0.01, far_m, "m"}, "an observation farther away is refused; of a place");
  f.number("forget_s", entry.forget_s, {0, forget_max_s, "s"},
           "age at which an observation does not count any more; 0: never");
  if (f.reading() && place != PlaceKind::none) {
    entry.places = place == PlaceKind::pose ? 3 : 2;
    entry.fields.push_back({"x_m", "m", "Where it is, ahead of the trunk", -within_m, within_m});
    entry.fields.push_back({"y_m", "m", "Where it is, left of the trunk", -within_m, within_m});
    if (place == PlaceKind::pose)
      entry.fields.push_back({"heading_rad", "rad", "Where it points, from where the trunk points", -7, 7});
  }
  f.map("fields", "further numbers, by name", [&](Fields& e) { seen_field(e, entry); });
  if (!f.reading()) return;
  const bool none = entry.fields.empty() && (placed || !f.has("place"));  // a wrong place is told already
  if (none || entry.fields.size() > max_seen_fields)
    f.refuse(f.key_place(), f.path() + " has " + std::to_string(entry.fields.size()) + " fields, it must have 1.." +
                                std::to_string(max_seen_fields) + ", those of its place included");
  if (all.size() == max_seen)
    f.refuse(f.key_place(), "the world model has at most " + std::to_string(max_seen) + " entries");
  all.push_back(std::move(entry));
}

constexpr std::size_t peers_max = 16;

void messages_fields(Fields& f, MessagesConfig& messages) {
  std::vector<PlacedName> peers, to;
  f.string("name", messages.name, "this robot's name among them", Need::required);
  f.strings("peers", peers, {1, peers_max}, "the names of the robots that it hears", Need::required);
  f.string("listen", messages.listen, "host:port at which a run listens, such as :17132");
  f.strings("to", to, {0, peers_max},
            "host:port to which a run sends: each robot's, or the network's broadcast address");
  f.integer("messages_per_minute", messages.messages_per_minute, {1, 6000}, "most that it sends in a minute");
  f.integer("bytes_per_minute", messages.bytes_per_minute, {100, 3'000'000}, "most bytes of them in a minute");
  f.number("age_max_s", messages.age_max_s, {0.01, 60, "s"},
           "how much longer than the fastest one a message may take; an older one is refused");
  if (!f.reading()) return;
  if (!is_name(messages.name)) f.refuse("name", std::string(" must be ") + name_rule);
  for (const PlacedName& peer : peers) {
    if (!is_name(peer.name)) f.refuse(peer.place, f.path("peers") + ": a name must be " + name_rule);
    if (peer.name == messages.name) f.refuse(peer.place, f.path("peers") + ": a robot does not hear itself");
  }
  messages.peers = names_of(peers);
  messages.to = names_of(to);
}

}  // namespace

void supervisor_fields(Fields& f, SupervisorConfig& config, const PlayFolders& folders) {
  config = {.given = true};
  std::string decisions, lost = "go_on";
  f.string("decisions", decisions, "what decides: a k.decisions, by its name in the robot's behaviors or its file");
  f.number("rate_Hz", config.rate_Hz, {1, 100, "Hz"}, "how often it decides");
  f.number("lost_after_s", config.lost_after_s, {0.05, 60, "s"}, "without a decision for so long it is lost");
  f.string("when_lost", lost, "what happens when it is lost: go_on, stop, or a list of behaviors that takes over");
  f.map("world", "what the robot may know of the world: s.seen.NAME", [&](Fields& e) { seen_entry(e, config.seen); });
  f.string("perception", config.perception,
           "host:port at which a run listens for datagrams of what is seen, such as 127.0.0.1:17131");
  f.object("messages", "messages between robots", [&](Fields& e) { messages_fields(e, config.messages); });
  if (!f.reading()) return;
  if (config.lost_after_s * config.rate_Hz < 2) f.refuse("lost_after_s", " is shorter than two periods of rate_Hz");
  if (!decisions.empty()) config.decisions = read_play_items(decisions, f.place("decisions"), folders, f.problems());
  if (config.decisions.size() > 1) f.refuse("decisions", " names one k.decisions, which plays the others");
  config.when_lost = lost == "go_on"  ? SupervisorConfig::WhenLost::go_on
                     : lost == "stop" ? SupervisorConfig::WhenLost::stop
                                      : SupervisorConfig::WhenLost::play;
  if (config.when_lost == SupervisorConfig::WhenLost::play)
    config.lost_list = read_play_items(lost, f.place("when_lost"), folders, f.problems());
}

}  // namespace kadans
