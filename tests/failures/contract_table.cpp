// The table of docs/failures.md, as a reporter of doctest:
//   failures_test --test-suite=contract --reporters=contract_table
#include <filesystem>
#include <map>
#include <string>
#include <utility>

#include <doctest/doctest.h>

namespace {

class ContractTable final : public doctest::IReporter {
 public:
  explicit ContractTable(const doctest::ContextOptions& options) : out_(*options.cout) {}

  void test_run_start() override {
    out_ << "# What goes wrong, and what happens then\n\n"
            "Made from the tests of tests/failures and how they end; renew it with `scripts/failures`. How soon each "
            "fault\n"
            "is found stands in src/safety/detection.h. The death of the runtime itself "
            "and a\n"
            "slow viewer are not in this table.\n\n"
            "| what goes wrong | what the runtime promises | test | result |\n|---|---|---|---|\n";
  }
  void test_case_start(const doctest::TestCaseData& test) override { test_ = &test; }
  void test_case_end(const doctest::CurrentTestCaseStats& stats) override {
    const std::string file = std::filesystem::path(test_->m_file.c_str()).filename().string();
    rows_[{file, test_->m_line}] = std::string("| ") + test_->m_description + " | " + test_->m_name +
                                   " | tests/failures/" + file + " | " + (stats.testCaseSuccess ? "passed" : "FAILED") +
                                   " |\n";
  }
  void report_query(const doctest::QueryData&) override {}
  void test_run_end(const doctest::TestRunStats&) override {
    for (const auto& [place, row] : rows_) out_ << row.c_str();
  }
  void test_case_reenter(const doctest::TestCaseData&) override {}
  void test_case_exception(const doctest::TestCaseException&) override {}
  void subcase_start(const doctest::SubcaseSignature&) override {}
  void subcase_end() override {}
  void log_assert(const doctest::AssertData&) override {}
  void log_message(const doctest::MessageData&) override {}
  void test_case_skipped(const doctest::TestCaseData&) override {}

 private:
  std::ostream& out_;
  const doctest::TestCaseData* test_ = nullptr;
  std::map<std::pair<std::string, unsigned>, std::string> rows_;  // by file and line, however they were compiled
};

}  // namespace

REGISTER_REPORTER("contract_table", 1, ContractTable);
