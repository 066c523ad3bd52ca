#pragma once
// UTIAS multi-robot cooperative localization and mapping (Leung, Halpern, Barfoot, Liu, IJRR 2011):
// five robots with commanded velocities and a camera that measures range and bearing to 15
// barcodes.

#include <libslam/io/importers/imported_log.hpp>

namespace libslam {

/// `directory` is one MRCLAM_DatasetN; `robot` 1..5. Files optionally with ".gz".
///
/// The command of row k holds from t_k to t_{k+1}. The column "subject" of the measurements is the
/// barcode; it becomes the subject number, landmarks 6..20. Measurements of other robots and of
/// codes that no landmark carries are left out (counted in `remarks`). The truth is cut to the time
/// of the odometry and thinned to 50 Hz; data sets without a truth file have a true map alone.
/// Throws InputError.
ImportedLog import_mrclam(const std::string& directory, int robot);

}  // namespace libslam
