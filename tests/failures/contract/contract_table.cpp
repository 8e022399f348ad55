// The table of docs/failures.md, as a reporter of doctest:
//   failures_test --test-suite=contract --list-test-cases --reporters=contract_table
#include <filesystem>
#include <map>
#include <string>
#include <utility>

#include <doctest/doctest.h>

namespace {

class ContractTable final : public doctest::IReporter {
 public:
  explicit ContractTable(const doctest::ContextOptions& options) : out_(*options.cout) {}

  void report_query(const doctest::QueryData& query) override {
    out_ << "# What goes wrong, and what happens then\n\n"
            "Made from the tests of tests/failures/contract, one a row; `scripts/failures` runs them and renews it. "
            "How soon each\n"
            "fault is found stands in src/safety/detection.h. The death of the runtime itself and a slow viewer are "
            "not in\n"
            "this table.\n\n"
            "| what goes wrong | what the runtime promises | test |\n|---|---|---|\n";
    std::map<std::pair<std::string, unsigned>, std::string> rows;  // by file and line, however they were compiled
    for (unsigned i = 0; i < query.num_data; ++i) {
      const doctest::TestCaseData& test = *query.data[i];
      const std::string file = std::filesystem::path(test.m_file.c_str()).filename().string();
      rows[{file, test.m_line}] =
          std::string("| ") + test.m_description + " | " + test.m_name + " | tests/failures/contract/" + file + " |\n";
    }
    for (const auto& [place, row] : rows) out_ << row.c_str();
  }
  void test_run_start() override {}
  void test_run_end(const doctest::TestRunStats&) override {}
  void test_case_start(const doctest::TestCaseData&) override {}
  void test_case_end(const doctest::CurrentTestCaseStats&) override {}
  void test_case_reenter(const doctest::TestCaseData&) override {}
  void test_case_exception(const doctest::TestCaseException&) override {}
  void subcase_start(const doctest::SubcaseSignature&) override {}
  void subcase_end() override {}
  void log_assert(const doctest::AssertData&) override {}
  void log_message(const doctest::MessageData&) override {}
  void test_case_skipped(const doctest::TestCaseData&) override {}

 private:
  std::ostream& out_;
};

}  // namespace

REGISTER_REPORTER("contract_table", 1, ContractTable);
