// SPDX-License-Identifier: GPL-3.0-or-later

#include "DemCoupling.H"

#include <algorithm>

#include "slabs.H"

namespace
{

//- The deck's variables, as the segment gives them
std::vector<std::pair<std::string, std::string>> deckVariables(const dictionary& segment)
{
    std::vector<std::pair<std::string, std::string>> variables;
    for (const char* name : {"parameters", "restart", "output", "decks"})
    {
        variables.emplace_back(name, segment.get<fileName>(name));
    }
    variables.emplace_back("steps", "0");
    variables.emplace_back("start_step", std::to_string(segment.get<label>("start_step")));
    return variables;
}

}

bedFoam::DemCoupling::DemCoupling(
    const fvMesh& mesh, const dictionary& parameters, const dictionary& gas, const dictionary& segment
)
    : properties_(parameters, gas, mesh.time().deltaTValue()),
      steps_(parameters.get<label>("coupling_steps")),
      grid_(ownSlab(parameters)),
      deposit_(properties_, grid_),
      drag_(properties_, grid_, gas),
      forces_(properties_, grid_, parameters),
      dem_(segment.get<fileName>("deck"), deckVariables(segment))
{
    checkSlabs(mesh, grid_, dem_, 1e-6 * properties_.diameter);
    const Time& time = mesh.time();
    dem_.start(steps_ * std::lround((time.endTime() - time).value() / properties_.interval));
    if (segment.get<label>("start_step") == 0)
    {
        // Before the first exchange nothing but drag is known to have acted
        for (int i = 0; i < dem_.count(); ++i) std::copy_n(dem_.velocity()[i], 3, dem_.draggedVelocity()[i]);
    }
}

void bedFoam::DemCoupling::deposit(const volVectorField& U, SolidsFields& solids)
{
    deposit_.depositVolume(dem_, solids.voidage);
    drag_.update(dem_, deposit_.stencils(), U, solids.voidage);
    deposit_.depositDrag(drag_.drags(), solids.dragRate, solids.dragSource);
}

void bedFoam::DemCoupling::applyForces(const GasFields& gas, const SolidsFields& solids)
{
    forces_.apply(deposit_.stencils(), drag_.drags(), gas, solids, dem_);
}
