// SPDX-License-Identifier: GPL-3.0-or-later
//
// bedFoam: gas (OpenFOAM, model A, incompressible) and particles (LIGGGHTS) of a fluidized bed, coupled
// both ways in one process a rank.
//
//   bedFoam -case FOLDER        FOLDER holds caseParameters, segmentParameters and an OpenFOAM case
//
// Each step: particles to the next exchange, their voidage and drag to the gas, gas to the end of the
// step, its forces back to the particles.

#include <cstdio>

#include <mpi.h>

#include "IFstream.H"
#include "fvCFD.H"
#include "pisoControl.H"

#include "BedSeries.H"
#include "DemCoupling.H"
#include "Guards.H"
#include "Inlet.H"
#include "RunReport.H"
#include "fields.H"
#include "gasEquations.H"

namespace
{

dictionary readDictionary(const fileName& file)
{
    if (!isFile(file)) FatalErrorInFunction << "there is no " << file << exit(FatalError);
    return dictionary(IFstream(file)());
}

//- Run the segment of a case, from its start time to its end time
void runSegment(const argList& args)
{
    Time runTime(Time::controlDictName, args);
    fvMesh mesh(IOobject(fvMesh::defaultRegion, runTime.timeName(), runTime, IOobject::MUST_READ));
    const dictionary parameters = readDictionary(runTime.globalPath() / "caseParameters");
    const dictionary segment = readDictionary(runTime.globalPath() / "segmentParameters");
    const dictionary properties = readDictionary(runTime.globalPath() / "constant" / "gasProperties");
    const dimensionedScalar viscosity(
        "viscosity", dimViscosity, properties.get<scalar>("viscosity") / properties.get<scalar>("density")
    );
    const label rowEvery = segment.get<label>("row_every");

    pisoControl piso(mesh);
    const bedFoam::Inlet inlet(mesh, properties);
    bedFoam::GasFields gas(mesh);
    const bedFoam::Reconstruction reconstruct(mesh);
    bedFoam::SolidsFields solids(mesh);

    bedFoam::DemCoupling particles(mesh, parameters, properties, segment);
    particles.deposit(gas.U, solids);
    solids.voidage.oldTime();
    bedFoam::Guards guards(mesh, parameters, properties, particles.dem());
    guards.checkParticles(particles.dem());
    guards.checkVoidage(particles.clips());
    bedFoam::RunReport report(runTime);
    bedFoam::BedSeries series(runTime);

    while (runTime.loop())
    {
        particles.advance();
        report.charge(bedFoam::RunReport::dem);

        guards.checkParticles(particles.dem());
        particles.deposit(gas.U, solids);
        guards.checkVoidage(particles.clips());
        report.charge(bedFoam::RunReport::exchange);

        inlet.setVelocity(solids.voidage, gas.U, gas.phi);
        const surfaceScalarField voidagef("voidagef", fvc::interpolate(solids.voidage));
        const tmp<fvVectorMatrix> UEqn = bedFoam::solveMomentum(solids, voidagef, viscosity, piso, gas);
        const bedFoam::PressureCorrector pressure(UEqn(), solids, voidagef, reconstruct, gas);
        while (piso.correct()) pressure.correct(guards, piso, gas);
        pressure.setGradient(gas);
        report.charge(bedFoam::RunReport::gas);

        particles.applyForces(gas, solids);
        report.charge(bedFoam::RunReport::exchange);

        const bedFoam::BedState bed = particles.bed();
        const scalar pressureDrop = inlet.pressureDrop(gas.p);
        guards.checkFinite(pressureDrop, bed.kineticEnergy, gas.U);
        series.carry(pressureDrop, particles.forces().shareOnGas(), bed.onFloor, bed.onSides);
        if (runTime.timeIndex() % rowEvery == 0)
        {
            series.row(
                {inlet.superficialVelocity(), bed.meanHeight, bed.kineticEnergy, bed.number,
                 gMin(solids.voidage.primitiveField()), particles.clips().number,
                 bedFoam::volumeImbalance(solids.voidage, voidagef, gas.phi),
                 particles.forces().dragImbalance(), guards.takeDeepestOverlap()}
            );
        }
        report.progress();
    }

    runTime.writeNow();
    particles.writeRestart(segment.get<fileName>("output") / "particles.restart");
    report.finish();
}

}

int main(int argc, char* argv[])
{
    // LIGGGHTS ends with MPI_Abort: without this its error line would stay in the buffer
    std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);

    argList::addNote("Gas and particles of a fluidized bed, coupled both ways");
    argList args(argc, argv);
    if (!args.checkRootCase()) FatalError.exit();

    // OpenFOAM starts MPI only in parallel, LIGGGHTS needs it always
    if (!Pstream::parRun()) MPI_Init(&argc, &argv);
    runSegment(args);
    if (!Pstream::parRun()) MPI_Finalize();
    return 0;
}
