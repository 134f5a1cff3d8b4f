// One seat: who sits there, their link, their answers, and what can be done.
import type { JSX } from 'preact';
import { useNow } from '../clock';
import { answerText, whereabouts } from '../live/group_table';
import type { Answer, RoomRow, SeatRow, StudyInfo } from '../protocol';
import { LinkBox } from '../setup/link_box';
import { counted } from '../../shared/texts';
import { estimateText, roomTitle, seatTitle, typeLabel } from '../words';
import { type Action, lower, seatActions } from './actions';
import { Dialog } from './dialog';

interface SeatDialogProps {
  study: StudyInfo;
  room: RoomRow;
  seat: SeatRow;
  answers: Answer[];
  mayAct: boolean;
  onAct: (action: Action) => void;
  onClose: () => void;
}

export function SeatDialog({ study, room, seat, answers, mayAct, onAct, onClose }: SeatDialogProps): JSX.Element {
  const now = useNow();
  const own = answers.filter((answer) => answer.seat === seat.seat);
  const right = own.filter((answer) => answer.right).length;
  const actions = mayAct ? seatActions(room, seat, study) : [];
  return (
    <Dialog title={`${seatTitle(seat)}, ${lower(roomTitle(room))}`} onClose={onClose} wide>
      <dl class="facts">
        <dt>State</dt>
        <dd>{whereabouts(seat, now)}</dd>
        {seat.type && <dt>Learner type</dt>}
        {seat.type && <dd>{`${seat.type}, ${typeLabel(study, seat.type)}`}</dd>}
        {seat.latency_ms !== undefined && <dt>Latency</dt>}
        {seat.latency_ms !== undefined && <dd>{Math.round(seat.latency_ms)} ms</dd>}
        {seat.estimate !== undefined && <dt>Screening (expected share right)</dt>}
        {seat.estimate !== undefined && <dd>{`${estimateText(seat.estimate)}${seat.estimate_is_high ? ', counts as high' : ''}`}</dd>}
        <dt>Answers</dt>
        <dd>{own.length === 0 ? 'none yet' : `${right} of ${counted(own.length, 'answer')} right`}</dd>
        {seat.code && <dt>Completion code</dt>}
        {seat.code && <dd class="code">{seat.code}</dd>}
      </dl>
      {seat.link && <LinkBox label="Link of this seat" link={seat.link} />}
      {own.length > 0 && <Answers answers={own} />}
      {actions.length > 0 && (
        <div class="dialog-buttons">
          {actions.map((action) => (
            <button type="button" class={action.isDangerous ? 'danger' : undefined} onClick={() => onAct(action)}>
              {action.label}
            </button>
          ))}
        </div>
      )}
    </Dialog>
  );
}

function Answers({ answers }: { answers: Answer[] }): JSX.Element {
  return (
    <div class="seat-answers" role="region" aria-label="Answers" tabIndex={0}>
      <table>
        <thead>
          <tr>
            <th scope="col">Period</th>
            <th scope="col">Test</th>
            <th scope="col">Answer</th>
          </tr>
        </thead>
        <tbody>
          {answers.map((answer) => (
            <tr>
              <td>{answer.period}</td>
              <td>{answer.test}</td>
              <td>{answerText(answer)}</td>
            </tr>
          ))}
        </tbody>
      </table>
    </div>
  );
}
