// SPDX-License-Identifier: Apache-2.0
// Estimates the offset of the daemon's clock. Half the round trip of a ping bounds the error, so the
// shortest of the last few round trips is used.

interface Sample {
  offsetUs: number;
  roundTripUs: number;
}

export class ServerClock {
  private samples: Sample[] = [];

  /** `kept`: how many answers are remembered, so that drifting clocks are followed. */
  constructor(private readonly kept = 30) {}

  /** All in microseconds: sent and received here, `serverUs` there. */
  add(sentUs: number, receivedUs: number, serverUs: number): void {
    if (receivedUs < sentUs) return;
    this.samples.push({
      offsetUs: serverUs - (sentUs + receivedUs) / 2,
      roundTripUs: receivedUs - sentUs,
    });
    if (this.samples.length > this.kept) this.samples.shift();
  }

  reset(): void {
    this.samples = [];
  }

  private best(): Sample | null {
    let best: Sample | null = null;
    for (const sample of this.samples) {
      if (best === null || sample.roundTripUs < best.roundTripUs) best = sample;
    }
    return best;
  }

  /** Microseconds to add to our clock, or null before the first answer. */
  offsetUs(): number | null {
    return this.best()?.offsetUs ?? null;
  }

  roundTripUs(): number | null {
    return this.best()?.roundTripUs ?? null;
  }
}
