// SPDX-License-Identifier: GPL-3.0-or-later

#include "bedState.H"

bedFoam::BedState bedFoam::bedState(const Liggghts& dem, const Properties& properties)
{
    const double weight = properties.weight;
    BedState bed{0, 0, scalar(dem.count()), dem.floorForce() / weight, dem.sideForce() / weight};
    for (int i = 0; i < dem.count(); ++i)
    {
        const double* v = dem.velocity()[i];
        bed.meanHeight += dem.position()[i][2];
        bed.kineticEnergy += 0.5 * properties.mass * (sqr(v[0]) + sqr(v[1]) + sqr(v[2]));
    }
    for (scalar* sum : {&bed.meanHeight, &bed.kineticEnergy, &bed.number, &bed.onFloor, &bed.onSides})
    {
        reduce(*sum, sumOp<scalar>());
    }
    for (scalar* mean : {&bed.meanHeight, &bed.onFloor, &bed.onSides}) *mean /= max(bed.number, scalar(1));
    return bed;
}
