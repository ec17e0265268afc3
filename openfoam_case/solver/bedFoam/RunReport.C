// SPDX-License-Identifier: GPL-3.0-or-later

#include "RunReport.H"

namespace
{

constexpr double secondsPerLine = 2;

}

bedFoam::RunReport::RunReport(const Time& time) : time_(time), startTime_(time.value())
{
    if (!Pstream::master()) return;
    table_.open(time.globalPath() / "bed_series.csv");
    table_.precision(10);
    table_
        << "time_s,inlet_velocity_m_s,pressure_drop_Pa,weight_on_gas_1,weight_on_floor_1,weight_on_sides_1,"
           "mean_height_m,kinetic_energy_J,particles_1,smallest_voidage_1,voidage_clips_1,volume_balance_1,"
           "exchange_error_1,"
           "largest_overlap_1\n";
}

void bedFoam::RunReport::charge(Part part)
{
    const auto now = Clock::now();
    spent_[part] += seconds(now - lap_);
    lap_ = now;
}

void bedFoam::RunReport::carry(scalar pressureDrop, scalar onGas, scalar onFloor, scalar onSides)
{
    const std::array<double, 4> step{{pressureDrop, onGas, onFloor, onSides}};
    for (size_t i = 0; i < step.size(); ++i) carried_[i] += step[i];
    ++carriedSteps_;
}

void bedFoam::RunReport::row(const Row& values)
{
    if (Pstream::master())
    {
        table_ << time_.value() << ',' << values.inletVelocity;
        for (const double sum : carried_) table_ << ',' << sum / carriedSteps_;
        table_ << ',' << values.meanHeight << ',' << values.kineticEnergy << ',' << values.number << ','
               << values.smallestVoidage << ',' << values.clipped << ',' << values.volumeBalance << ','
               << values.exchangeError << ',' << values.deepestOverlap << '\n';
    }
    carried_ = {};
    carriedSteps_ = 0;
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

void bedFoam::RunReport::finish()
{
    table_.close();
    Info << "totals simulated " << time_.value() - startTime_ << " wall " << seconds(Clock::now() - start_)
         << " dem " << spent_[dem] << " exchange " << spent_[exchange] << " gas " << spent_[gas] << endl;
}
