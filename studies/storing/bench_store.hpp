#pragma once

/// @file
/// What a bench leaves: `bench.h5` with everything, from which an interrupted bench goes on, and the same as
/// `bench.json`.

#include <filesystem>
#include <string>

#include "studies/cases/bench.hpp"
#include "studies/storing/provenance.hpp"

namespace acstudy {

/// Under which samples may be kept: the case, the code that computes it, the number of threads.
std::string bench_key(const BenchCase& one);

/// Writes `<out>/bench.h5` and `<out>/bench.json`, each whole or not at all. Cases that have not run are left out.
/// @param complete  every case has its number of runs and its time
/// @throws StoreError
void write_bench(const std::filesystem::path& out, const Bench& bench, const BenchOptions& options,
                 const Provenance& provenance, bool complete);

/// Gives the cases of `bench` the results and samples that `<out>/bench.h5` has of them, if there is such a file and it
/// is of this machine. Returns how many got some.
/// @throws StoreError if the file is there but is no bench, or not as it was written
std::size_t take_up_bench(const std::filesystem::path& out, Bench& bench);

}  // namespace acstudy
