// SPDX-License-Identifier: GPL-3.0-or-later

#include "Deposit.H"

namespace
{

// Closest discs fill 0.6046 of a slab one diameter thick and spheres 0.74 of space: a lower voidage is no bed
constexpr double smallestVoidage = 0.2;

}

void bedFoam::Deposit::depositVolume(const Liggghts& dem, volScalarField& voidage)
{
    stencils_.resize(dem.count());
    SlabField<1> solids = grid_.field<1>();
    for (size_t i = 0; i < stencils_.size(); ++i)
    {
        stencils_[i] = grid_.locate(dem.position()[i]);
        grid_.deposit<1>(solids, stencils_[i], {{properties_.volume}});
    }
    grid_.completeDeposit<1>(solids);

    clips_ = VoidageClips();
    scalarField& values = voidage.primitiveFieldRef();
    forAll(values, cell)
    {
        const double value = 1 - solids[grid_.place(cell)][0] / grid_.cellVolume();
        if (value < smallestVoidage) ++clips_.number;
        if (value < clips_.least)
        {
            clips_.least = value;
            clips_.cell = cell;
        }
        values[cell] = max(value, smallestVoidage);
    }
    reduce(clips_.number, sumOp<label>());
    voidage.correctBoundaryConditions();
}

void bedFoam::Deposit::depositDrag(
    const std::vector<Drag>& drags, volScalarField& dragRate, volVectorField& dragSource
) const
{
    using Four = std::array<double, 4>;
    SlabField<4> sums = grid_.field<4>();
    for (size_t i = 0; i < drags.size(); ++i)
    {
        Four given{{drags[i].coefficient}};
        for (int d = 0; d < 3; ++d) given[d + 1] = drags[i].coefficient * drags[i].undragged[d];
        grid_.deposit<4>(sums, stencils_[i], given);
    }
    grid_.completeDeposit<4>(sums);

    const double perVolume = 1 / (properties_.gasDensity * grid_.cellVolume());
    forAll(dragRate, cell)
    {
        const Four& value = sums[grid_.place(cell)];
        dragRate[cell] = perVolume * value[0];
        dragSource[cell] = perVolume * vector(value[1], value[2], value[3]);
    }
    dragRate.correctBoundaryConditions();
    dragSource.correctBoundaryConditions();
}
