// SPDX-License-Identifier: GPL-3.0-or-later

#include "BedSeries.H"

bedFoam::BedSeries::BedSeries(const Time& time) : time_(time)
{
    if (!Pstream::master()) return;
    table_.open(time.globalPath() / "bed_series.csv");
    table_.precision(10);
    table_
        << "time_s,inlet_velocity_m_s,pressure_drop_Pa,weight_on_gas_1,weight_on_floor_1,weight_on_sides_1,"
           "mean_height_m,kinetic_energy_J,particles_1,smallest_voidage_1,voidage_clips_1,volume_balance_1,"
           "exchange_error_1,largest_overlap_1\n";
}

void bedFoam::BedSeries::carry(scalar pressureDrop, scalar onGas, scalar onFloor, scalar onSides)
{
    const std::array<double, 4> step{{pressureDrop, onGas, onFloor, onSides}};
    for (size_t i = 0; i < step.size(); ++i) carried_[i] += step[i];
    ++carriedSteps_;
}

void bedFoam::BedSeries::row(const Row& values)
{
    if (Pstream::master())
    {
        table_ << time_.value() << ',' << values.inletVelocity;
        for (const double sum : carried_) table_ << ',' << sum / carriedSteps_;
        table_ << ',' << values.meanHeight << ',' << values.kineticEnergy << ',' << values.number << ','
               << values.smallestVoidage << ',' << values.clipped << ',' << values.volumeImbalance << ','
               << values.dragImbalance << ',' << values.deepestOverlap << '\n';
    }
    carried_ = {};
    carriedSteps_ = 0;
}
