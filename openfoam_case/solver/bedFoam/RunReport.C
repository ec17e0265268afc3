// SPDX-License-Identifier: GPL-3.0-or-later

#include "RunReport.H"

namespace
{

constexpr double secondsPerLine = 2;

}

void bedFoam::RunReport::charge(Part part)
{
    const auto now = Clock::now();
    spent_[part] += seconds(now - lap_);
    lap_ = now;
}

void bedFoam::RunReport::progress()
{
    const auto now = Clock::now();
    if (seconds(now - lastLine_) < secondsPerLine) return;
    lastLine_ = now;
    const double simulated = time_.value() - startTime_;
    const double cost = seconds(now - start_) / max(simulated, VSMALL);
    const double total = max(spent_[dem] + spent_[exchange] + spent_[gas], VSMALL);
    const auto share = [&](Part part) { return label(100 * spent_[part] / total + 0.5); };
    Info << "progress time " << time_.value() << " s, " << cost << " s per simulated second, "
         << cost * (time_.endTime().value() - time_.value()) << " s left, DEM " << share(dem)
         << " % exchange " << share(exchange) << " % gas " << share(gas) << " %" << endl;
}

void bedFoam::RunReport::finish() const
{
    Info << "totals simulated " << time_.value() - startTime_ << " wall " << seconds(Clock::now() - start_)
         << " dem " << spent_[dem] << " exchange " << spent_[exchange] << " gas " << spent_[gas] << endl;
}
