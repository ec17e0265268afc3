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

#include "Function1.H"
#include "IFstream.H"
#include "fvCFD.H"
#include "pisoControl.H"

#include "DemCoupling.H"
#include "Guards.H"
#include "RunReport.H"

int main(int argc, char* argv[])
{
    // LIGGGHTS ends with MPI_Abort: without this its error line would stay in the buffer
    std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);

    argList::addNote("Gas and particles of a fluidized bed, coupled both ways");
    argList args(argc, argv);
    if (!args.checkRootCase()) FatalError.exit();

    // OpenFOAM starts MPI only in parallel, LIGGGHTS needs it always
    if (!Pstream::parRun()) MPI_Init(&argc, &argv);

    {
#include "createTime.H"
#include "createMesh.H"

        const auto read = [](const fileName& file)
        {
            if (!isFile(file)) FatalErrorInFunction << "there is no " << file << exit(FatalError);
            return dictionary(IFstream(file)());
        };
        const dictionary parameters(read(runTime.globalPath() / "caseParameters"));
        const dictionary segment(read(runTime.globalPath() / "segmentParameters"));
        const dictionary gas(read(runTime.globalPath() / "constant" / "gasProperties"));
        const dimensionedScalar viscosity(
            "viscosity", dimViscosity, gas.get<scalar>("viscosity") / gas.get<scalar>("density")
        );
        const scalar gasDensity = gas.get<scalar>("density");
        const auto superficialVelocity = Function1<scalar>::New("superficialVelocity", gas);
        const label rowEvery = segment.get<label>("row_every");

        pisoControl piso(mesh);
#include "createFields.H"

        bedFoam::DemCoupling particles(mesh, parameters, gas, segment);
        particles.deposit(U, voidage, dragRate, dragSource);
        voidage.oldTime();
        bedFoam::Guards guards(mesh, parameters, gas, particles.dem());
        guards.checkParticles(particles.dem());
        guards.checkVoidage(particles);
        bedFoam::RunReport report(runTime);

        while (runTime.loop())
        {
            particles.advance();
            report.charge(bedFoam::RunReport::dem);

            guards.checkParticles(particles.dem());
            particles.deposit(U, voidage, dragRate, dragSource);
            guards.checkVoidage(particles);
            report.charge(bedFoam::RunReport::exchange);

#include "setInlet.H"
            const surfaceScalarField voidagef("voidagef", fvc::interpolate(voidage));
            {
#include "UEqn.H"
                while (piso.correct())
                {
#include "pEqn.H"
                }
            }
            report.charge(bedFoam::RunReport::gas);

            particles.applyForces(U, gradP, dragRate, dragSource);
            report.charge(bedFoam::RunReport::exchange);

#include "reportStep.H"
        }

        runTime.writeNow();
        particles.writeRestart(segment.get<fileName>("output") / "particles.restart");
        report.finish();
    }

    if (!Pstream::parRun()) MPI_Finalize();
    return 0;
}
