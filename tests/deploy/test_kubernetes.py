#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The Kubernetes manifests have the types of the API, and their parts fit each other and furrowd."""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import yaml

SOURCE = pathlib.Path(os.environ["FURROW_SOURCE"])
BIN = pathlib.Path(os.environ["FURROW_BIN"])
MANIFESTS = SOURCE / "deploy" / "kubernetes"
CHECK = SOURCE / "tests" / "deploy" / "kubernetes"
MODULES = CHECK / "node_modules"

# Kinds that the npm package has no types of.
KUSTOMIZE = "kustomize.config.k8s.io/v1beta1"
FOREIGN = {"Kustomization", "ServiceMonitor"}


def documents(folder=MANIFESTS):
    """All resources of a folder's kustomization, and the kustomization itself."""
    kustomization = yaml.safe_load((folder / "kustomization.yaml").read_text())
    found = [kustomization]
    for name in kustomization["resources"]:
        found += [each for each in yaml.safe_load_all((folder / name).read_text()) if each]
    return found


def of_kind(kind, all_documents=None):
    return [each for each in all_documents or documents() if each["kind"] == kind]


def module_of(api_version):
    """Where the package has the types of an API: apps/v1, core/v1, networking/v1."""
    group, _, version = api_version.rpartition("/")
    return f"{group.split('.')[0] or 'core'}/{version}"


def type_errors(resources):
    """What the TypeScript compiler says of the resources as literals of their types."""
    lines = []
    for i, resource in enumerate(resources):
        kind, module = resource["kind"], module_of(resource["apiVersion"])
        lines.append(f'import {{ {kind} as T{i} }} from "kubernetes-types/{module}";')
        lines.append(f"export const r{i}: T{i} = {json.dumps(resource)};")
    with tempfile.TemporaryDirectory(dir=CHECK) as folder:
        source = pathlib.Path(folder) / "manifests.ts"
        source.write_text("\n".join(lines) + "\n")
        done = subprocess.run(["node", MODULES / "typescript" / "bin" / "tsc", "--noEmit", "--strict", "--skipLibCheck",
                               "--moduleResolution", "node10", "--module", "es2020", "--target", "es2020", source],
                              capture_output=True, text=True, check=False)
        return done.stdout + done.stderr


def containers():
    for workload in of_kind("StatefulSet"):
        pod = workload["spec"]["template"]["spec"]
        for container in pod["containers"]:
            yield workload, pod, container


class Manifests(unittest.TestCase):
    def test_have_the_types_of_the_api(self):
        resources = [each for each in documents() if each["kind"] not in FOREIGN]
        self.assertGreaterEqual(len(resources), 6)
        self.assertEqual(type_errors(resources), "")

    def test_a_wrong_field_would_be_found(self):
        budget = of_kind("PodDisruptionBudget")[0]
        budget["spec"]["maxUnavailabel"] = 1
        self.assertIn("maxUnavailabel", type_errors([budget]))
        workload = of_kind("StatefulSet")[0]
        workload["spec"]["replicas"] = "three"
        self.assertIn("not assignable", type_errors([workload]))

    def test_the_files_of_a_folder_are_all_used(self):
        for folder in (MANIFESTS, MANIFESTS / "monitoring"):
            kustomization = documents(folder)[0]
            self.assertEqual(kustomization["apiVersion"], KUSTOMIZE)
            files = {path.name for path in folder.glob("*.yaml")} - {"kustomization.yaml"}
            self.assertEqual(files, set(kustomization["resources"]))

    def test_selectors_find_their_pods_and_ports(self):
        workloads = of_kind("StatefulSet")
        for service in of_kind("Service"):
            pods = [each["spec"]["template"] for each in workloads
                    if service["spec"]["selector"].items() <= each["spec"]["template"]["metadata"]["labels"].items()]
            self.assertEqual(len(pods), 1, service["metadata"]["name"])
            ports = {port["name"]: port for port in pods[0]["spec"]["containers"][0]["ports"]}
            for port in service["spec"]["ports"]:
                self.assertEqual(port["protocol"], ports[port["targetPort"]]["protocol"])
                self.assertEqual(port["port"], ports[port["targetPort"]]["containerPort"])
        for workload in workloads:
            self.assertEqual(workload["spec"]["selector"]["matchLabels"],
                             workload["spec"]["template"]["metadata"]["labels"])
            self.assertIn(workload["spec"]["serviceName"], [each["metadata"]["name"] for each in of_kind("Service")])
        labels = [each["spec"]["template"]["metadata"]["labels"] for each in workloads]
        for budget in of_kind("PodDisruptionBudget"):
            self.assertIn(budget["spec"]["selector"]["matchLabels"], labels)
        for policy in of_kind("NetworkPolicy"):
            self.assertIn(policy["spec"]["podSelector"]["matchLabels"], labels)

    def test_containers_have_no_privileges(self):
        for _, pod, container in containers():
            self.assertTrue(pod["securityContext"]["runAsNonRoot"])
            self.assertFalse(pod["automountServiceAccountToken"])
            security = container["securityContext"]
            self.assertFalse(security["allowPrivilegeEscalation"])
            self.assertTrue(security["readOnlyRootFilesystem"])
            self.assertEqual(security["capabilities"], {"drop": ["ALL"]})
            self.assertIn("memory", container["resources"]["limits"])

    def test_probes_ask_ports_that_exist(self):
        for _, _, container in containers():
            names = [port["name"] for port in container["ports"]]
            for probe in ("startupProbe", "livenessProbe", "readinessProbe"):
                self.assertIn(container[probe]["httpGet"]["port"], names)

    def test_mounts_and_secrets_exist(self):
        readme = (MANIFESTS / "README.md").read_text()
        for _, pod, container in containers():
            volumes = {volume["name"]: volume for volume in pod["volumes"]}
            self.assertEqual({mount["name"] for mount in container["volumeMounts"]}, set(volumes))
            for volume in volumes.values():
                if "secret" not in volume:
                    continue
                # furrowd reads them through the group of the pod and refuses files that others may read.
                self.assertEqual(volume["secret"]["defaultMode"], 0o440)
                self.assertRegex(readme, rf"create secret \w+ {volume['secret']['secretName']}\b")

    def test_furrowd_knows_its_arguments(self):
        known = subprocess.run([BIN / "furrowd", "--help"], capture_output=True, text=True, check=True).stdout
        for workload, _, container in containers():
            if workload["metadata"]["name"] != "furrowd":
                continue
            for argument in container["args"]:
                flag = argument.partition("=")[0]
                self.assertRegex(known, rf"(?m)^\s+{re.escape(flag)}\b", flag)
            files = [argument.partition("=")[2] for argument in container["args"] if "=/" in argument]
            self.assertGreater(len(files), 0)
            for file in files:
                self.assertIn(str(pathlib.Path(file).parent), [mount["mountPath"] for mount in container["volumeMounts"]])

    # The Prometheus operator's own types are in no npm package.
    def test_the_service_monitor_finds_the_daemons(self):
        monitor = of_kind("ServiceMonitor", documents(MANIFESTS / "monitoring"))[0]
        self.assertEqual(monitor["apiVersion"], "monitoring.coreos.com/v1")
        service = [each for each in of_kind("Service") if each["metadata"]["name"] == "furrowd"][0]
        self.assertLessEqual(monitor["spec"]["selector"]["matchLabels"].items(), service["metadata"]["labels"].items())
        endpoint = monitor["spec"]["endpoints"][0]
        self.assertIn(endpoint["port"], [port["name"] for port in service["spec"]["ports"]])
        self.assertEqual(endpoint["path"], "/metrics")
        rules = (SOURCE / "deploy" / "prometheus" / "furrow.rules.yml").read_text()
        job = [each["replacement"] for each in endpoint["relabelings"] if each["targetLabel"] == "job"][0]
        self.assertIn(f'job="{job}"', rules)
        self.assertIn(endpoint["authorization"]["credentials"]["name"], (MANIFESTS / "README.md").read_text())


if __name__ == "__main__":
    if not MODULES.is_dir():
        print("the npm packages of tests/deploy/kubernetes are not installed")
        sys.exit(77)
    unittest.main()
