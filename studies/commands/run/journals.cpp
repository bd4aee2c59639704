#include "studies/commands/run/journals.hpp"

#include <exception>
#include <system_error>
#include <utility>

namespace acstudy {

void Journals::save() {
  for (std::size_t s = 0; s < studies_.size(); ++s) {
    const std::filesystem::path journal = journal_path(out_, studies_[s].study->name);
    Finished saved;
    try {
      std::vector<char> record;
      {
        const std::lock_guard lock(mutex_);
        if (unsaved_[s].empty()) continue;
        record = journal_record(studies_[s], unsaved_[s]);
        std::swap(saved, unsaved_[s]);
      }
      append_to_journal(journal, record);
      saved = {};
    } catch (const std::exception&) {
      // What cannot be saved is tried again a second later; the end of the run says why if that fails, too.
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
}

}  // namespace acstudy
