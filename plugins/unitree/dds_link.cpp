#include "dds_link.h"

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <string_view>

#include <pthread.h>

#include "kadans/signal/input_error.h"
#include "low_level.h"  // made by idlc from low_level.idl

namespace unitree {
namespace {

constexpr std::int32_t samples_kept = 8;
constexpr int library_priority = 79;  // below the bus's own thread

// Threads and buffers as small as the traffic is: in a run all of it is locked into memory.
constexpr const char* sizes =
    "<CycloneDDS><Domain Id=\"any\">"
    "<Sizing><ReceiveBufferSize>512 kB</ReceiveBufferSize><ReceiveBufferChunkSize>128 "
    "kB</ReceiveBufferChunkSize></Sizing>"
    "<Internal><MaxSampleSize>64 kB</MaxSampleSize><MultipleReceiveThreads>false</MultipleReceiveThreads></Internal>"
    "<Threads><Thread Name=\"recv\"><StackSize>256 kB</StackSize></Thread>"
    "<Thread Name=\"tev\"><StackSize>256 kB</StackSize></Thread>"
    "<Thread Name=\"gc\"><StackSize>256 kB</StackSize></Thread>"
    "<Thread Name=\"dq.builtins\"><StackSize>256 kB</StackSize></Thread>"
    "<Thread Name=\"dq.user\"><StackSize>256 kB</StackSize></Thread></Threads></Domain></CycloneDDS>";

constexpr const char* this_machine =
    "<CycloneDDS><Domain Id=\"any\">"
    "<General><Interfaces><NetworkInterface address=\"127.0.0.1\" multicast=\"false\"/></Interfaces>"
    "<AllowMulticast>false</AllowMulticast></General>"
    "<Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>32</MaxAutoParticipantIndex>"
    "<Peers><Peer address=\"127.0.0.1\"/></Peers></Discovery></Domain></CycloneDDS>";

std::string configuration_for(const Settings& settings) {
  const char* const asked = std::getenv("CYCLONEDDS_URI");  // NOLINT(concurrency-mt-unsafe): nobody sets it
  const std::string own(sizes);
  if (settings.interface == "lo") return own + "," + this_machine;
  if (!settings.interface.empty())
    return own + ",<CycloneDDS><Domain Id=\"any\"><General><Interfaces><NetworkInterface name=\"" + settings.interface +
           "\"/></Interfaces></General></Domain></CycloneDDS>";
  return own + "," + (asked == nullptr || *asked == '\0' ? this_machine : asked);
}

bool is_word(std::string_view text) {
  return std::ranges::all_of(text,
                             [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '.'; });
}

// The library's threads take after the one that makes them: they must not take the program's signals, and those that
// bring the states come before all but the bus's own thread. Without the right to that they are usual threads.
class ThreadsOfBus {
 public:
  ThreadsOfBus() {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &signals_);
    pthread_getschedparam(pthread_self(), &policy_, &parameter_);
    sched_param raised{};
    raised.sched_priority = library_priority;
    (void)pthread_setschedparam(pthread_self(), SCHED_FIFO, &raised);
  }
  ~ThreadsOfBus() {
    (void)pthread_setschedparam(pthread_self(), policy_, &parameter_);
    pthread_sigmask(SIG_SETMASK, &signals_, nullptr);
  }
  ThreadsOfBus(const ThreadsOfBus&) = delete;
  ThreadsOfBus& operator=(const ThreadsOfBus&) = delete;

 private:
  sigset_t signals_{};
  int policy_ = SCHED_OTHER;
  sched_param parameter_{};
};

dds_qos_t* newest(std::int32_t depth, dds_reliability_kind_t kind) {
  dds_qos_t* const qos = dds_create_qos();
  dds_qset_reliability(qos, kind, 0);
  dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, depth);
  return qos;
}

class DdsLink final : public DriverLink {
 public:
  explicit DdsLink(const Settings& settings)
      : family_(settings.kind->family),
        domain_(settings),
        states_(domain_.reader(state_type(family_), state_topic, DdsDomain::Own::ignored, samples_kept)),
        others_(domain_.reader(command_type(family_), command_topic, DdsDomain::Own::ignored, samples_kept)),
        commands_(domain_.writer(command_type(family_), command_topic)) {
    domain_.watch(states_);
  }

  bool send(const Packet& command) noexcept override { return dds_write(commands_, command.words.data()) >= 0; }
  bool take(Packet& state) noexcept override { return take_packet(states_, state_words(family_), state); }
  std::uint32_t foreign_commands() noexcept override {
    std::uint32_t count = 0;
    while (count < samples_kept && take_packet(others_, command_words(family_), foreign_)) ++count;
    return count;
  }
  void wait(std::int64_t until_ns) noexcept override { domain_.wait_for(until_ns - now_ns()); }
  std::int64_t now_ns() const noexcept override {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return std::int64_t{now.tv_sec} * kadans::ns_per_s + now.tv_nsec;
  }
  std::string other_kind() override { return domain_.other_types(state_topic, state_type(family_).m_typename); }
  bool has_peer() override { return writers_of(states_) > 0; }

 private:
  Family family_;
  DdsDomain domain_;
  dds_entity_t states_, others_, commands_;
  Packet foreign_;
};

}  // namespace

DdsDomain::DdsDomain(const Settings& settings) : place_(settings.place()) {
  if (!is_word(settings.interface))
    throw kadans::InputError({.message = "'" + settings.interface + "' is no name of a network card"});
  const ThreadsOfBus they_are;
  dds_set_log_sink([](void*, const dds_log_data_t*) {}, nullptr);  // rubbish from the network makes it say much
  domain_ = dds_create_domain(settings.domain, configuration_for(settings).c_str());
  if (domain_ == DDS_RETCODE_PRECONDITION_NOT_MET)
    throw kadans::InputError({.message = place_ + " is in use in this program already: --ros2 needs another domain"});
  (void)checked(domain_, "cannot be opened: is there such a network card, and does it have an address?");
  participant_ = dds_create_participant(settings.domain, nullptr, nullptr);
  waitset_ = participant_ < 0 ? participant_ : dds_create_waitset(participant_);
  if (waitset_ >= 0) return;
  (void)dds_delete(domain_);
  (void)checked(waitset_, "lets nobody in: is there such a network card, and does it have an address?");
}

DdsDomain::~DdsDomain() { (void)dds_delete(domain_); }

dds_entity_t DdsDomain::checked(dds_entity_t entity, const std::string& what) const {
  if (entity >= 0) return entity;
  throw kadans::InputError({.message = place_ + " " + what + " (" + dds_strretcode(entity) + ")"});
}

dds_entity_t DdsDomain::topic(const dds_topic_descriptor_t& type, const char* name) {
  return checked(dds_create_topic(participant_, &type, name, nullptr, nullptr), std::string("has no topic ") + name);
}

dds_entity_t DdsDomain::writer(const dds_topic_descriptor_t& type, const char* name) {
  const dds_entity_t of = topic(type, name);
  dds_qos_t* const qos = newest(1, DDS_RELIABILITY_RELIABLE);
  const dds_entity_t made = dds_create_writer(participant_, of, qos, nullptr);
  dds_delete_qos(qos);
  return checked(made, std::string("takes no writer of ") + name);
}

dds_entity_t DdsDomain::reader(const dds_topic_descriptor_t& type, const char* name, Own own, std::int32_t depth) {
  const dds_entity_t of = topic(type, name);
  dds_qos_t* const qos = newest(depth, DDS_RELIABILITY_BEST_EFFORT);
  if (own == Own::ignored) dds_qset_ignorelocal(qos, DDS_IGNORELOCAL_PARTICIPANT);
  const dds_entity_t made = dds_create_reader(participant_, of, qos, nullptr);
  dds_delete_qos(qos);
  return checked(made, std::string("takes no reader of ") + name);
}

void DdsDomain::watch(dds_entity_t reader) {
  (void)dds_set_status_mask(reader, DDS_DATA_AVAILABLE_STATUS);
  (void)checked(dds_waitset_attach(waitset_, reader, reader), "cannot be waited for");
}

void DdsDomain::wait_for(std::int64_t ns) noexcept {
  if (ns > 0) (void)dds_waitset_wait(waitset_, nullptr, 0, ns);
}

std::string DdsDomain::other_types(const char* topic, const char* type) const {
  const dds_entity_t reader = dds_create_reader(participant_, DDS_BUILTIN_TOPIC_DCPSPUBLICATION, nullptr, nullptr);
  std::string found;
  for (;;) {
    void* sample = nullptr;
    dds_sample_info_t info{};
    if (reader < 0 || dds_take(reader, &sample, &info, 1, 1) <= 0) break;
    const auto* const endpoint = static_cast<const dds_builtintopic_endpoint_t*>(sample);
    const std::string_view other = info.valid_data && std::string_view(endpoint->topic_name) == topic
                                       ? std::string_view(endpoint->type_name).substr(0, 80)
                                       : std::string_view();
    if (!other.empty() && other != type && found.find(other) == std::string::npos)
      found.append(found.empty() ? "" : ", ").append(other);
    (void)dds_return_loan(reader, &sample, 1);
  }
  (void)dds_delete(reader);
  return found;
}

// Into a place of its own, which is all 0 before: what lies between the fields stays 0.
bool take_packet(dds_entity_t reader, std::size_t words, Packet& packet, dds_instance_handle_t* from) noexcept {
  for (;;) {
    std::fill_n(packet.words.begin(), words, 0);
    void* sample = packet.words.data();
    dds_sample_info_t info{};
    if (dds_take(reader, &sample, &info, 1, 1) <= 0) return false;
    if (!info.valid_data) continue;  // a writer has gone
    packet.count = words;
    if (from != nullptr) *from = info.publication_handle;
    return true;
  }
}

std::uint32_t writers_of(dds_entity_t reader) noexcept {
  dds_subscription_matched_status_t status{};
  return dds_get_subscription_matched_status(reader, &status) < 0 ? 0 : status.current_count;
}

std::uint32_t readers_of(dds_entity_t writer) noexcept {
  dds_publication_matched_status_t status{};
  return dds_get_publication_matched_status(writer, &status) < 0 ? 0 : status.current_count;
}

const dds_topic_descriptor_t& command_type(Family family) noexcept {
  return family == Family::go ? unitree_go_msg_dds__LowCmd__desc : unitree_hg_msg_dds__LowCmd__desc;
}

const dds_topic_descriptor_t& state_type(Family family) noexcept {
  return family == Family::go ? unitree_go_msg_dds__LowState__desc : unitree_hg_msg_dds__LowState__desc;
}

std::unique_ptr<DriverLink> make_dds_link(const Settings& settings) { return std::make_unique<DdsLink>(settings); }

}  // namespace unitree
