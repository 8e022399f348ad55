#include "dds_domain.h"

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <future>
#include <string_view>
#include <system_error>
#include <thread>

#include <dlfcn.h>

#include "engine/behavior_log.h"
#include "kadans/signal/input_error.h"
#include "signal/input_file.h"
#include "signal/quiet_thread.h"

namespace kadans {
namespace {

constexpr int lines_max = 20;
constexpr std::size_t line_max_bytes = 200;
constexpr dds_duration_t write_max_ns = 100'000'000;
constexpr std::chrono::seconds leave_max{2};

// Threads and buffers as small as the traffic is: in a run all of it is locked into memory.
constexpr const char* sizes =
    "<CycloneDDS><Domain Id=\"any\">"
    "<Sizing><ReceiveBufferSize>512 kB</ReceiveBufferSize><ReceiveBufferChunkSize>128 "
    "kB</ReceiveBufferChunkSize></Sizing>"
    "<Internal><MaxSampleSize>4 MB</MaxSampleSize><MultipleReceiveThreads>false</MultipleReceiveThreads></Internal>"
    "<Threads>"
    "<Thread Name=\"recv\"><StackSize>256 kB</StackSize></Thread><Thread Name=\"tev\"><StackSize>256 "
    "kB</StackSize></Thread>"
    "<Thread Name=\"gc\"><StackSize>256 kB</StackSize></Thread>"
    "<Thread Name=\"dq.builtins\"><StackSize>256 kB</StackSize></Thread>"
    "<Thread Name=\"dq.user\"><StackSize>256 kB</StackSize></Thread>"
    "</Threads></Domain></CycloneDDS>";

constexpr const char* loopback =
    "<CycloneDDS><Domain Id=\"any\">"
    "<General><Interfaces><NetworkInterface address=\"127.0.0.1\" multicast=\"false\"/></Interfaces>"
    "<AllowMulticast>false</AllowMulticast></General>"
    "<Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>32</MaxAutoParticipantIndex>"
    "<Peers><Peer address=\"127.0.0.1\"/></Peers></Discovery>"
    "</Domain></CycloneDDS>";

void say(BehaviorLog::Severity severity, std::string_view text) {
  program_log().message(Line::no_time, severity, "ros2", text);
}

// What the library has to say, as far as somebody may want to read it: rubbish from the network makes it say much.
void tell(void*, const dds_log_data_t* data) {
  static std::atomic<int> told{0};
  const int line = told.fetch_add(1, std::memory_order_relaxed);
  if (line >= lines_max) {
    told.store(lines_max, std::memory_order_relaxed);
    return;
  }
  const std::string_view text = std::string_view(data->message, data->size).substr(0, line_max_bytes);
  say(BehaviorLog::Severity::warning, text.substr(0, text.find('\n')));
  if (line + 1 == lines_max) say(BehaviorLog::Severity::warning, "no more of this");
}

template <typename Function>
void find(void* library, const char* name, Function& function) {
  function = reinterpret_cast<Function>(dlsym(library, name));
  if (function == nullptr) refuse(KADANS_DDS_LIBRARY, std::string("has no ") + name);
}

DdsApi load() {
  void* const library = dlopen(KADANS_DDS_LIBRARY, RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr)
    refuse("--ros2", std::string("needs Cyclone DDS (apt-get install libddsc0debian): ") +
                         dlerror());  // NOLINT(concurrency-mt-unsafe): before any thread
  DdsApi api{};
#define KADANS_FIND(name) find(library, #name, api.name)
  KADANS_FIND(dds_create_domain);
  KADANS_FIND(dds_create_participant);
  KADANS_FIND(dds_create_topic);
  KADANS_FIND(dds_create_writer);
  KADANS_FIND(dds_create_reader);
  KADANS_FIND(dds_create_qos);
  KADANS_FIND(dds_delete_qos);
  KADANS_FIND(dds_qset_reliability);
  KADANS_FIND(dds_qset_durability);
  KADANS_FIND(dds_qset_history);
  KADANS_FIND(dds_write);
  KADANS_FIND(dds_take);
  KADANS_FIND(dds_return_loan);
  KADANS_FIND(dds_delete);
  KADANS_FIND(dds_strretcode);
  KADANS_FIND(dds_set_log_sink);
#undef KADANS_FIND
  return api;
}

}  // namespace

DdsDomain::DdsDomain(std::uint32_t domain) : api_(dds_api()), number_(domain) {
  const char* const asked = std::getenv("CYCLONEDDS_URI");  // NOLINT(concurrency-mt-unsafe): nobody sets it
  const bool own = asked == nullptr || *asked == '\0';
  std::string configuration(sizes);
  configuration.append(",").append(own ? loopback : asked);
  api_.dds_set_log_sink(tell, nullptr);
  domain_ = checked(api_.dds_create_domain(domain, configuration.c_str()),
                    own ? "cannot be opened" : "cannot be opened with what CYCLONEDDS_URI says");
  participant_ = api_.dds_create_participant(domain, nullptr, nullptr);
  if (participant_ >= 0) return;
  (void)api_.dds_delete(domain_);
  (void)checked(participant_, "lets nobody in");
}

// After a flood of rubbish dds_delete of Cyclone 0.10.2 was seen to wait for longer than five seconds: then the domain
// is left behind, for the end of the process to take.
DdsDomain::~DdsDomain() {
  std::promise<void> gone;
  const std::future<void> over = gone.get_future();
  try {
    const SignalsBlocked blocked;
    std::thread([&api = api_, domain = domain_, gone = std::move(gone)]() mutable {
      (void)api.dds_delete(domain);
      gone.set_value();
    }).detach();
  } catch (const std::system_error&) {
    return;  // no thread to be had
  }
  if (over.wait_for(leave_max) == std::future_status::timeout)
    say(BehaviorLog::Severity::warning, "the DDS library does not leave its domain; the run ends without that");
}

dds_entity_t DdsDomain::checked(dds_entity_t entity, const std::string& what) const {
  if (entity >= 0) return entity;
  throw InputError(InputProblem{
      .file = "--ros2",
      .message = "DDS domain " + std::to_string(number_) + " " + what + ": " + api_.dds_strretcode(entity)});
}

dds_entity_t DdsDomain::topic(const dds_topic_descriptor_t& type, const std::string& name) const {
  return checked(api_.dds_create_topic(participant_, &type, name.c_str(), nullptr, nullptr), "has no topic " + name);
}

template <typename Create>
dds_entity_t DdsDomain::with_quality(const DdsQuality& quality, Create&& create) const {
  dds_qos_t* const qos = api_.dds_create_qos();
  api_.dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, write_max_ns);
  api_.dds_qset_durability(qos, quality.for_late_readers ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
  api_.dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, quality.depth);
  const dds_entity_t made = create(qos);
  api_.dds_delete_qos(qos);
  return made;
}

dds_entity_t DdsDomain::writer(const dds_topic_descriptor_t& type, const std::string& name, const DdsQuality& quality) {
  const dds_entity_t of = topic(type, name);
  return checked(
      with_quality(quality, [&](dds_qos_t* qos) { return api_.dds_create_writer(participant_, of, qos, nullptr); }),
      "takes no writer of " + name);
}

dds_entity_t DdsDomain::reader(const dds_topic_descriptor_t& type, const std::string& name, const DdsQuality& quality) {
  const dds_entity_t of = topic(type, name);
  return checked(
      with_quality(quality, [&](dds_qos_t* qos) { return api_.dds_create_reader(participant_, of, qos, nullptr); }),
      "takes no reader of " + name);
}

const DdsApi& dds_api() {
  static const DdsApi api = load();
  return api;
}

}  // namespace kadans
