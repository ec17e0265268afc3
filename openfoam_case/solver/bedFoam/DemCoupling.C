// SPDX-License-Identifier: GPL-3.0-or-later

#include "DemCoupling.H"

#include <algorithm>

namespace
{

// Closest discs fill 0.6046 of a slab one diameter thick and spheres 0.74 of space: a lower voidage is no bed
constexpr double smallestVoidage = 0.2;

bedFoam::DragLaw namedDragLaw(const dictionary& gas)
{
    const std::string name = gas.get<word>("drag");
    const bedFoam::DragLaw law = bedFoam::dragLaw(name);
    if (!law)
    {
        FatalIOErrorInFunction(gas) << "drag law " << name << " does not exist; there are";
        for (const std::string& known : bedFoam::dragLawNames()) FatalIOError << ' ' << known;
        FatalIOError << exit(FatalIOError);
    }
    return law;
}

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
    : mesh_(mesh),
      gasDensity_(gas.get<scalar>("density")),
      gasViscosity_(gas.get<scalar>("viscosity")),
      diameter_(parameters.get<scalar>("diameter")),
      mass_(parameters.get<scalar>("density") * constant::mathematical::pi / 6 * pow3(diameter_)),
      volume_(constant::mathematical::pi / 6 * pow3(diameter_)),
      gravity_(parameters.get<scalar>("gravity")),
      weight_((mass_ - gasDensity_ * volume_) * gravity_),
      interval_(mesh.time().deltaTValue()),
      steps_(parameters.get<label>("coupling_steps")),
      freeAcross_(parameters.get<label>("depth_walls") == 1),
      dragLaw_(namedDragLaw(gas)),
      dem_(segment.get<fileName>("deck"), deckVariables(segment)),
      grid_(slab(parameters))
{
    grid_.setSmoothingLength(parameters.get<scalar>("smoothing_diameters") * diameter_);
    checkSlabs();
    const Time& time = mesh.time();
    dem_.start(steps_ * std::lround((time.endTime() - time).value() / interval_));
    if (segment.get<label>("start_step") == 0)
    {
        // Before the first exchange nothing but drag is known to have acted
        for (int i = 0; i < dem_.count(); ++i) std::copy_n(dem_.velocity()[i], 3, dem_.draggedVelocity()[i]);
    }
}

bedFoam::SlabGrid bedFoam::DemCoupling::slab(const dictionary& parameters) const
{
    const int ranks = Pstream::nProcs();
    const std::array<int, 3> cells{
        static_cast<int>(parameters.get<label>("gas_cells_x")),
        static_cast<int>(parameters.get<label>("gas_cells_y")),
        static_cast<int>(parameters.get<label>("gas_cells_z"))
    };
    if (cells[0] % ranks)
    {
        FatalErrorInFunction << cells[0] << " gas cells along x cannot be cut into " << ranks
                             << " equal slabs:"
                             << " choose gas.cell_size_m or run.ranks so that they can" << exit(FatalError);
    }
    const double low = parameters.get<scalar>("slab_low");
    const std::array<double, 3> size{
        parameters.get<scalar>("width") / cells[0], (parameters.get<scalar>("slab_high") - low) / cells[1],
        parameters.get<scalar>("height") / cells[2]
    };
    const int own = cells[0] / ranks;
    return SlabGrid(
        {own, cells[1], cells[2]}, {Pstream::myProcNo() * own * size[0], low, 0}, size, Pstream::myProcNo(),
        ranks
    );
}

void bedFoam::DemCoupling::checkSlabs() const
{
    const double tolerance = 1e-6 * diameter_;
    const bool sameCells = mesh_.nCells() == grid_.size() && [&]()
    {
        for (label cell = 0; cell < mesh_.nCells(); ++cell)
        {
            const auto centre = grid_.centre(cell);
            if (mag(mesh_.C()[cell] - vector(centre[0], centre[1], centre[2])) > tolerance) return false;
        }
        return true;
    }();
    const boundBox box(mesh_.points(), false);
    const bool sameSlab = mag(box.min().x() - dem_.slab().first) < tolerance
        && mag(box.max().x() - dem_.slab().second) < tolerance;
    if (!returnReduce(sameCells && sameSlab, andOp<bool>()))
    {
        FatalErrorInFunction
            << "gas mesh and particle domain are not cut into the same slabs: the mesh must be the block of"
            << " system/blockMeshDict, cut by system/decomposeParDict" << exit(FatalError);
    }
}

void bedFoam::DemCoupling::advance() { dem_.advance(steps_); }

void bedFoam::DemCoupling::depositVolume(volScalarField& voidage)
{
    particles_.resize(dem_.count());
    SlabField<1> solids = grid_.field<1>();
    for (size_t i = 0; i < particles_.size(); ++i)
    {
        particles_[i].stencil = grid_.locate(dem_.position()[i]);
        grid_.deposit<1>(solids, particles_[i].stencil, {{volume_}});
    }
    grid_.completeDeposit<1>(solids);

    clipped_ = 0;
    leastVoidage_ = {1, -1};
    scalarField& values = voidage.primitiveFieldRef();
    forAll(values, cell)
    {
        const double value = 1 - solids[grid_.place(cell)][0] / grid_.cellVolume();
        if (value < smallestVoidage) ++clipped_;
        if (value < leastVoidage_.first) leastVoidage_ = {value, cell};
        values[cell] = max(value, smallestVoidage);
    }
    reduce(clipped_, sumOp<label>());
    voidage.correctBoundaryConditions();
}

void bedFoam::DemCoupling::depositDrag(
    const volVectorField& U, const volScalarField& voidage, volScalarField& dragRate,
    volVectorField& dragSource
)
{
    using Four = std::array<double, 4>;
    SlabField<4> gas = gridField<4>([&](Four& value, label cell)
                                    { value = {{U[cell].x(), U[cell].y(), U[cell].z(), voidage[cell]}}; });
    grid_.prepareSample<4>(gas);

    const double* const* velocity = dem_.velocity();
    const double* const* dragged = dem_.draggedVelocity();
    SlabField<4> drag = grid_.field<4>();
    for (size_t i = 0; i < particles_.size(); ++i)
    {
        Exchange& particle = particles_[i];
        const Four around = grid_.sample<4>(gas, particle.stencil);
        const double slip = std::sqrt(
            sqr(around[0] - velocity[i][0]) + sqr(around[1] - velocity[i][1])
            + sqr(around[2] - velocity[i][2])
        );
        const double explicitDrag = dragLaw_({around[3], diameter_, slip, gasDensity_, gasViscosity_});
        particle.drag = explicitDrag / (1 + interval_ * explicitDrag / mass_);

        Four given{{particle.drag}};
        for (int d = 0; d < 3; ++d)
        {
            particle.undragged[d] = 2 * velocity[i][d] - dragged[i][d];
            given[d + 1] = particle.drag * particle.undragged[d];
        }
        grid_.deposit<4>(drag, particle.stencil, given);
    }
    grid_.completeDeposit<4>(drag);

    const double perVolume = 1 / (gasDensity_ * grid_.cellVolume());
    forAll(dragRate, cell)
    {
        const Four& value = drag[grid_.place(cell)];
        dragRate[cell] = perVolume * value[0];
        dragSource[cell] = perVolume * vector(value[1], value[2], value[3]);
    }
    dragRate.correctBoundaryConditions();
    dragSource.correctBoundaryConditions();
}

void bedFoam::DemCoupling::deposit(
    const volVectorField& U, volScalarField& voidage, volScalarField& dragRate, volVectorField& dragSource
)
{
    depositVolume(voidage);
    depositDrag(U, voidage, dragRate, dragSource);
}

void bedFoam::DemCoupling::applyForces(
    const volVectorField& U, const volVectorField& gradP, const volScalarField& dragRate,
    const volVectorField& dragSource
)
{
    using Six = std::array<double, 6>;
    SlabField<6> gas = gridField<6>(
        [&](Six& value, label cell)
        {
            for (direction d = 0; d < 3; ++d)
            {
                value[d] = U[cell][d];
                value[d + 3] = gradP[cell][d];
            }
        }
    );
    grid_.prepareSample<6>(gas);

    const double* const* velocity = dem_.velocity();
    double* const* force = dem_.force();
    double* const* dragged = dem_.draggedVelocity();
    vector dragOnParticles = Zero;
    scalar dragSize = 0, lift = 0;
    for (size_t i = 0; i < particles_.size(); ++i)
    {
        const Exchange& particle = particles_[i];
        const Six around = grid_.sample<6>(gas, particle.stencil);
        for (int d = 0; d < 3; ++d)
        {
            // Across a single layer even a force of round-off would make the bed buckle. Where one gas cell
            // spans many layers the gas does not move across them and its pressure is even, but it still
            // drags
            const bool drags = mesh_.solutionD()[d] > 0 || freeAcross_;
            const double drag = drags ? particle.drag * (around[d] - particle.undragged[d]) : 0;
            const double buoyancy = d == 2 ? volume_ * gasDensity_ * gravity_ : 0;
            const double pressure = mesh_.solutionD()[d] > 0 ? -volume_ * gasDensity_ * around[d + 3] : 0;
            force[i][d] = drag + pressure + buoyancy;
            dragged[i][d] = velocity[i][d] + interval_ * drag / mass_;
            dragOnParticles[d] += drag;
            dragSize += std::abs(drag);
            if (d == 2) lift += drag + pressure;
        }
    }
    reduce(lift, sumOp<scalar>());
    onGas_ = lift / max(weight_ * returnReduce(scalar(particles_.size()), sumOp<scalar>()), VSMALL);

    const vector dragOnGas = gasDensity_ * grid_.cellVolume()
        * sum(dragSource.primitiveField() - dragRate.primitiveField() * U.primitiveField());
    exchangeError_ = mag(returnReduce(dragOnParticles + dragOnGas, sumOp<vector>()))
        / max(returnReduce(dragSize, sumOp<scalar>()), VSMALL);
}

void bedFoam::DemCoupling::writeRestart(const fileName& path) { dem_.command("write_restart " + path); }

bedFoam::DemCoupling::Bed bedFoam::DemCoupling::bed() const
{
    Bed bed{0, 0, scalar(dem_.count()), dem_.floorForce() / weight_, dem_.sideForce() / weight_};
    for (int i = 0; i < dem_.count(); ++i)
    {
        const double* v = dem_.velocity()[i];
        bed.meanHeight += dem_.position()[i][2];
        bed.kineticEnergy += 0.5 * mass_ * (sqr(v[0]) + sqr(v[1]) + sqr(v[2]));
    }
    for (scalar* sum : {&bed.meanHeight, &bed.kineticEnergy, &bed.number, &bed.onFloor, &bed.onSides})
    {
        reduce(*sum, sumOp<scalar>());
    }
    for (scalar* mean : {&bed.meanHeight, &bed.onFloor, &bed.onSides}) *mean /= max(bed.number, scalar(1));
    return bed;
}
