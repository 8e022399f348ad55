// Both ends of the low level on DDS: Cyclone DDS as packaged.
//
// The card and the domain are the settings'. Without a card it is what CYCLONEDDS_URI says; without that the domain is
// confined to this machine. Writers are reliable, so that every reader matches them, but wait for nobody; readers take
// what comes, the newest few.
#pragma once

#include <memory>

#include <dds/dds.h>

#include "driver_link.h"
#include "settings.h"

namespace unitree {

// A domain with one participant; all in it ends with this object. One thread at a time.
class DdsDomain {
 public:
  enum class Own : bool { heard, ignored };  // by a reader: what this participant writes

  // Throws InputError that says what is in the way.
  explicit DdsDomain(const Settings& settings);
  ~DdsDomain();
  DdsDomain(const DdsDomain&) = delete;
  DdsDomain& operator=(const DdsDomain&) = delete;

  // Both throw InputError.
  dds_entity_t writer(const dds_topic_descriptor_t& type, const char* topic);
  dds_entity_t reader(const dds_topic_descriptor_t& type, const char* topic, Own own, std::int32_t depth);
  // Wakes wait_for() when something comes.
  void watch(dds_entity_t reader);
  // NOLINTNEXTLINE(readability-make-member-function-const): time passes
  void wait_for(std::int64_t ns) noexcept;
  // The types under which somebody writes to this topic, other than this one.
  std::string other_types(const char* topic, const char* type) const;

 private:
  dds_entity_t checked(dds_entity_t entity, const std::string& what) const;
  dds_entity_t topic(const dds_topic_descriptor_t& type, const char* name);

  std::string place_;
  dds_entity_t domain_ = 0, participant_ = 0, waitset_ = 0;
};

// Takes the oldest sample that waits, as words. False: none. `from`: who wrote it.
bool take_packet(dds_entity_t reader, std::size_t words, Packet& packet,
                 dds_instance_handle_t* from = nullptr) noexcept;
// How many match.
std::uint32_t writers_of(dds_entity_t reader) noexcept;
std::uint32_t readers_of(dds_entity_t writer) noexcept;

const dds_topic_descriptor_t& command_type(Family family) noexcept;
const dds_topic_descriptor_t& state_type(Family family) noexcept;
inline constexpr const char* command_topic = "rt/lowcmd";
inline constexpr const char* state_topic = "rt/lowstate";

// Throws InputError.
std::unique_ptr<DriverLink> make_dds_link(const Settings& settings);

}  // namespace unitree
