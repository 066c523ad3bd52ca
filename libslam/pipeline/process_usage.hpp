#pragma once
// What this process has used so far.

namespace libslam {

/// CPU time of all threads, user and system [s].
double cpu_seconds();
/// Largest resident memory so far [MB].
double peak_memory_mb();

}  // namespace libslam
