// The functions of Cyclone DDS that the bridge calls. The library is loaded when it is first needed. So a program that
// does not use ROS 2 neither needs the library nor pays for loading it (and OpenSSL and iceoryx with it).
#pragma once

#include <dds/dds.h>

namespace kadans {

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

}  // namespace kadans
