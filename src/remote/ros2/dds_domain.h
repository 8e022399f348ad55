// A participant of a DDS domain with its writers and readers of topics; all end with this object. One thread at a time.
//
// The domain uses only this machine's loopback device without multicast, unless CYCLONEDDS_URI sets something else.
// Incoming samples of more than a few MB are not assembled.
#pragma once

#include <cstdint>
#include <string>

#include <dds/dds.h>

namespace kadans {

// The functions of Cyclone DDS that the bridge calls. The library is loaded when it is first needed. So a program that
// does not use ROS 2 neither needs the library nor pays for loading it (and OpenSSL and iceoryx with it).
struct DdsApi {
  // NOLINTBEGIN(readability-identifier-naming): the library's own names
  decltype(&::dds_create_domain) dds_create_domain;
  decltype(&::dds_create_participant) dds_create_participant;
  decltype(&::dds_create_topic) dds_create_topic;
  decltype(&::dds_create_writer) dds_create_writer;
  decltype(&::dds_create_reader) dds_create_reader;
  decltype(&::dds_create_qos) dds_create_qos;
  decltype(&::dds_delete_qos) dds_delete_qos;
  decltype(&::dds_qset_reliability) dds_qset_reliability;
  decltype(&::dds_qset_durability) dds_qset_durability;
  decltype(&::dds_qset_history) dds_qset_history;
  decltype(&::dds_write) dds_write;
  decltype(&::dds_take) dds_take;
  decltype(&::dds_return_loan) dds_return_loan;
  decltype(&::dds_delete) dds_delete;
  decltype(&::dds_strretcode) dds_strretcode;
  decltype(&::dds_set_log_sink) dds_set_log_sink;
  // NOLINTEND(readability-identifier-naming)
};

// The first call loads the library; it stays until the process ends. Throws InputError that says how to install it.
const DdsApi& dds_api();

// The defaults of ROS 2: reliable, keep the newest `depth` samples. A reader that joins late gets nothing, or with
// for_late_readers the newest samples.
struct DdsQuality {
  std::int32_t depth = 10;
  bool for_late_readers = false;
};

class DdsDomain {
 public:
  // Throws InputError when there is no library, when CYCLONEDDS_URI is wrong, or when there is no such device.
  explicit DdsDomain(std::uint32_t domain);
  ~DdsDomain();
  DdsDomain(const DdsDomain&) = delete;
  DdsDomain& operator=(const DdsDomain&) = delete;

  // Both throw InputError.
  dds_entity_t writer(const dds_topic_descriptor_t& type, const std::string& topic, const DdsQuality& quality = {});
  dds_entity_t reader(const dds_topic_descriptor_t& type, const std::string& topic, const DdsQuality& quality = {});

  // False when it could not be written, for example because a reader has not taken the earlier samples for 100 ms.
  // NOLINTNEXTLINE(readability-make-member-function-const): it changes what others see
  bool write(dds_entity_t writer, const void* sample) noexcept { return api_.dds_write(writer, sample) >= 0; }
  // Takes the oldest waiting sample and calls `see` with it if its data are valid. False: no sample is waiting.
  template <typename Sample, typename See>
  bool take(dds_entity_t reader, See&& see) {
    void* sample = nullptr;
    dds_sample_info_t info{};
    if (api_.dds_take(reader, &sample, &info, 1, 1) <= 0) return false;
    struct Loan {
      const DdsApi& api;
      dds_entity_t from;
      void** sample;
      ~Loan() { (void)api.dds_return_loan(from, sample, 1); }
    } const loan{api_, reader, &sample};
    if (info.valid_data) see(*static_cast<const Sample*>(sample));
    return true;
  }

 private:
  dds_entity_t topic(const dds_topic_descriptor_t& type, const std::string& name) const;
  dds_entity_t checked(dds_entity_t entity, const std::string& what) const;
  template <typename Create>
  dds_entity_t with_quality(const DdsQuality& quality, Create&& create) const;

  const DdsApi& api_;
  std::uint32_t number_;
  dds_entity_t domain_ = 0, participant_ = 0;
};

}  // namespace kadans
