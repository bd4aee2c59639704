#include "studies/commands/run/journals.hpp"

#include <exception>
#include <system_error>
#include <utility>

namespace acstudy {

std::exception_ptr Journals::save() {
  std::exception_ptr failure;
  for (std::size_t s = 0; s < studies_.size(); ++s) {
    const std::filesystem::path journal = journal_path(out_, studies_[s].study->name, suffix_);
    Finished saved;
    try {
      std::vector<char> records;
      {
        const std::lock_guard lock(mutex_);
        if (unsaved_[s].empty()) continue;
        if (!begun_[s]) records = journal_head(*studies_[s].study);
        const std::vector<char> finished = journal_records(studies_[s], unsaved_[s]);
        records.insert(records.end(), finished.begin(), finished.end());
        std::swap(saved, unsaved_[s]);
      }
      append_to_journal(journal, records);
      begun_[s] = true;
      saved = {};
    } catch (const std::exception&) {
      // What cannot be saved is tried again a second later; the end of the run says why if that fails, too.
      failure = std::current_exception();
    }
    const std::lock_guard lock(mutex_);
    if (finished_[s]) {
      std::error_code ignored;
      std::filesystem::remove(journal, ignored);
    } else {
      unsaved_[s].cases.insert(unsaved_[s].cases.end(), saved.cases.begin(), saved.cases.end());
      unsaved_[s].findings.insert(unsaved_[s].findings.end(), saved.findings.begin(), saved.findings.end());
    }
  }
  return failure;
}

}  // namespace acstudy
